//! The page around plots and tables.

use std::fmt::Write;

pub(super) fn page(title: &str, parts: &[String]) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n<h1>{title}</h1>\n{body}</body>\n</html>\n",
        style = include_str!("style.css"),
        body = parts.concat(),
    )
}

pub(super) fn figure(title: &str, caption: &str, svg: &str) -> String {
    format!("<h2>{title}</h2>\n<figure><figcaption>{caption}</figcaption>\n{svg}</figure>\n")
}

/// The first column is text, the others are numbers.
pub(super) fn table(heads: &[&str], rows: &[Vec<String>]) -> String {
    let mut html = String::from("<table>\n<tr>");
    for head in heads {
        let _ = write!(html, "<th>{head}</th>");
    }
    html.push_str("</tr>\n");
    for row in rows {
        html.push_str("<tr>");
        for cell in row {
            let _ = write!(html, "<td>{cell}</td>");
        }
        html.push_str("</tr>\n");
    }
    html + "</table>\n"
}

pub(super) fn paragraph(text: &str) -> String {
    format!("<p>{text}</p>\n")
}
