//! Plots as SVG text, and the self-contained HTML page they stand on.

mod page;
mod plot;
mod thin;

pub use page::{Figure, Legend, document, escaped};
pub use plot::{
    BLUE, Curve, GREEN, GREY, ORANGE, PURPLE, TimePlot, WIDTH, draw_histogram, draw_path,
    label_style,
};
pub use plotters::style::RGBColor as Colour;
pub use thin::thinned;

#[derive(Debug, thiserror::Error)]
#[error("cannot draw a plot: {0}")]
pub struct ChartError(String);

impl ChartError {
    pub fn new(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}
