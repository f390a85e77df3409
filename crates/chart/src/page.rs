//! The HTML page around plots: one file that needs no other. Every text is escaped here.

use std::fmt::Write;

use plotters::style::RGBColor;

/// A drawn plot with its heading, caption and legend.
pub struct Figure {
    pub title: String,
    /// Says what the reader should look for.
    pub caption: String,
    pub legend: Vec<Legend>,
    pub svg: String,
}

/// The name of a curve beside its colour.
pub struct Legend {
    pub label: String,
    pub colour: RGBColor,
    pub faint: bool,
}

impl Figure {
    /// Returns the figure as a part of a page.
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

/// Returns the whole page; `body` is HTML, made by the other functions here.
pub fn document(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        title = escaped(title),
        style = include_str!("style.css"),
    )
}

/// Returns the page's title with a line under it.
pub fn header(title: &str, subtitle: &str) -> String {
    format!(
        "<header><div><h1>{}</h1><div class=\"soft\">{}</div></div></header>\n",
        escaped(title),
        escaped(subtitle)
    )
}

/// Returns a paragraph.
pub fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escaped(text))
}

/// Returns a table. Its first column holds text, the others numbers.
pub fn table(heads: &[&str], rows: &[Vec<String>]) -> String {
    let mut html = String::from("<table>\n<tr>");
    for (column, head) in heads.iter().enumerate() {
        cell(&mut html, "th", column, head);
    }
    html.push_str("</tr>\n");
    for row in rows {
        html.push_str("<tr>");
        for (column, text) in row.iter().enumerate() {
            cell(&mut html, "td", column, text);
        }
        html.push_str("</tr>\n");
    }
    html + "</table>\n"
}

fn cell(html: &mut String, tag: &str, column: usize, text: &str) {
    let class = if column == 0 { "" } else { " class=\"n\"" };
    let _ = write!(html, "<{tag}{class}>{}</{tag}>", escaped(text));
}

/// Returns the text with HTML's special characters escaped.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
        .replace('\'', "&#39;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Curve, GREY, TimePlot};

    const NAME: &str = "<script>alert('1')</script>";

    #[test]
    fn a_name_that_looks_like_html_stays_text() {
        let figure = Figure {
            title: NAME.to_owned(),
            caption: NAME.to_owned(),
            legend: vec![Legend {
                label: NAME.to_owned(),
                colour: GREY,
                faint: false,
            }],
            svg: plot_with(NAME),
        };
        let parts = [
            header(NAME, NAME),
            paragraph(NAME),
            table(&[NAME, NAME], &[vec![NAME.to_owned(), NAME.to_owned()]]),
            figure.html(),
        ];
        let html = document(NAME, &parts.concat());
        assert!(!html.contains("<script>"), "{html}");
        assert_eq!(html.matches("&lt;script&gt;").count(), 12, "{html}");
    }

    fn plot_with(unit: &str) -> String {
        let plot = TimePlot {
            unit,
            height: 200,
            time: 0.0..1.0,
            marks: &[],
            shaded: &[],
            curves: vec![Curve {
                label: String::new(),
                colour: GREY,
                faint: false,
                points: vec![(0.0, Some(1.0)), (1.0, Some(2.0))],
            }],
        };
        plot.draw().unwrap().unwrap()
    }
}
