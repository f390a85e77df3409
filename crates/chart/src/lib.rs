//! Plots as SVG text, and the self-contained HTML page around them.
//!
//! All reports of this project are made here, so that they look alike and no text in them is taken for HTML.
//!
//! ```
//! use robot_chart::{BLUE, Curve, Figure, TimePlot, document, header};
//!
//! let plot = TimePlot {
//!     unit: "m/s",
//!     height: 200,
//!     time: 0.0..2.0,
//!     marks: &[],
//!     shaded: &[],
//!     curves: vec![Curve {
//!         label: "speed".to_owned(),
//!         colour: BLUE,
//!         faint: false,
//!         points: vec![(0.0, Some(0.0)), (1.0, Some(0.8)), (2.0, None)],
//!     }],
//! };
//! let svg = plot.draw()?.expect("the curve has values");
//! let figure = Figure {
//!     title: "Speed".to_owned(),
//!     caption: "It rises.".to_owned(),
//!     legend: plot.legend(),
//!     svg,
//! };
//! let html = document("Drive", &(header("Drive", "seed 7") + &figure.html()));
//! assert!(html.contains("<h1>Drive</h1>"));
//! # Ok::<(), robot_chart::ChartError>(())
//! ```

mod canvas;
mod lanes;
mod page;
mod phase;
mod plot;
mod scatter;
mod thin;

pub use canvas::{
    Area, BLUE, DrawError, GREEN, GREY, ORANGE, PURPLE, WIDTH, label_style, svg as draw_svg,
};
pub use lanes::{Lane, draw_lanes};
pub use page::{Figure, Legend, document, escaped, header, paragraph, table};
pub use phase::Phase;
pub use plot::{Curve, TimePlot, draw_histogram, draw_path};
pub use plotters::style::RGBColor as Colour;
pub use scatter::{Cloud, before_and_after, draw_residuals};
pub use thin::thinned;

/// A plot could not be drawn.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw a plot: {0}")]
pub struct ChartError(String);

impl ChartError {
    pub fn new(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}
