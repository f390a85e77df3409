//! Parts that all drawings share: colours, the style of labels, and the SVG drawing area.

use plotters::{
    coord::Shift,
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

use crate::ChartError;

/// Width of a plot that fills the page, in pixels.
pub const WIDTH: u32 = 980;

/// Colours that colour-blind readers can tell apart (Okabe and Ito).
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const ORANGE: RGBColor = RGBColor(213, 94, 0);
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
pub const PURPLE: RGBColor = RGBColor(170, 80, 150);
pub const GREY: RGBColor = RGBColor(120, 120, 120);
const INK: RGBColor = RGBColor(50, 55, 60);
pub(crate) const GRID: RGBColor = RGBColor(225, 228, 232);

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub type DrawError<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

/// Returns what `draw` puts on an area of this size, in pixels, as SVG text.
pub fn svg(
    size: (u32, u32),
    draw: impl for<'a> FnOnce(&Area<'a>) -> Result<(), DrawError<'a>>,
) -> Result<String, ChartError> {
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
    draw(&area).map_err(ChartError::new)?;
    drop(area);
    Ok(text)
}

/// The style of all labels at axes.
pub fn label_style() -> TextStyle<'static> {
    TextStyle::from(("sans-serif", 15).into_font())
        .color(&INK)
        .pos(Pos::new(HPos::Left, VPos::Top))
}

/// The label of a time in s.
pub fn seconds(t_s: &f64) -> String {
    // The zero makes a negative zero positive.
    format!("{} s", (t_s * 1e4).round() / 1e4 + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_short_and_have_their_unit() {
        let labels = [-1e-9, 0.1 + 0.2, 12.0].map(|t| seconds(&t));
        assert_eq!(labels, ["0 s", "0.3 s", "12 s"]);
    }
}
