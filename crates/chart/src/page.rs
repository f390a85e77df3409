//! HTML around plots: one file that needs no other.

use plotters::style::RGBColor;

/// A drawn plot with its heading.
pub struct Figure {
    pub title: String,
    /// What the reader should look for.
    pub caption: String,
    pub legend: Vec<Legend>,
    pub svg: String,
}

pub struct Legend {
    pub label: String,
    pub colour: RGBColor,
    pub faint: bool,
}

impl Figure {
    pub fn html(&self) -> String {
        let class = if self.svg.contains("width=\"520\"") {
            " class=\"square\""
        } else {
            ""
        };
        format!(
            "<h2>{}</h2>\n<figure{class}><figcaption>{}{}</figcaption>\n{}</figure>\n",
            escaped(&self.title),
            escaped(&self.caption),
            self.legend.iter().map(Legend::html).collect::<String>(),
            self.svg
        )
    }
}

impl Legend {
    fn html(&self) -> String {
        let RGBColor(r, g, b) = self.colour;
        let class = if self.faint { "key faint" } else { "key" };
        format!(
            " <span class=\"{class}\" style=\"color: rgb({r} {g} {b})\">{}</span>",
            escaped(&self.label)
        )
    }
}

/// The whole page; `body` is HTML.
pub fn document(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        title = escaped(title),
        style = include_str!("style.css"),
    )
}

/// Text made safe inside HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
