//! Tables of figures, for a terminal and as JSON.

use std::{collections::BTreeMap, fmt};

use serde::Serialize;

/// Rows that have the same columns.
#[derive(Debug, Serialize)]
pub struct Group {
    pub title: &'static str,
    #[serde(skip)]
    pub columns: Vec<String>,
    pub rows: Vec<Row>,
}

#[derive(Debug, Serialize)]
pub struct Row {
    pub name: &'static str,
    pub unit: &'static str,
    /// The largest value allowed.
    pub limit: Option<f64>,
    /// Values by column. A column may have none.
    pub values: BTreeMap<String, f64>,
    /// Columns whose value is above the limit.
    pub broken: Vec<String>,
    #[serde(skip)]
    decimals: usize,
}

const NAME_WIDTH: usize = 42;
const CELL_WIDTH: usize = 14;

impl Group {
    pub fn new(title: &'static str, columns: impl IntoIterator<Item = String>) -> Self {
        Self {
            title,
            columns: columns.into_iter().collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row without a limit, with one value for each column.
    pub fn add(
        &mut self,
        name: &'static str,
        unit: &'static str,
        values: Vec<Option<f64>>,
    ) -> &mut Row {
        let named = self.columns.iter().cloned().zip(values);
        let values = named.filter_map(|(column, value)| Some((column, value?)));
        let row = Row {
            name,
            unit,
            limit: None,
            values: values.collect(),
            broken: Vec::new(),
            decimals: 0,
        };
        self.rows.push(row);
        self.rows.last_mut().expect("one was pushed")
    }
}

impl Row {
    pub fn decimals(&mut self, decimals: usize) -> &mut Self {
        self.decimals = decimals;
        self
    }

    /// Sets the limit for the columns named.
    pub fn at_most<'c>(&mut self, limit: f64, columns: impl IntoIterator<Item = &'c String>) {
        self.limit = Some(limit);
        let over = |column: &&String| self.values.get(*column).is_some_and(|v| *v > limit);
        self.broken = columns.into_iter().filter(over).cloned().collect();
    }
}

impl fmt::Display for Group {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<NAME_WIDTH$}{:>CELL_WIDTH$}", self.title, "limit")?;
        for column in &self.columns {
            write!(f, "{column:>CELL_WIDTH$}")?;
        }
        for row in &self.rows {
            let name = match row.unit {
                "" => format!("  {}", row.name),
                unit => format!("  {} [{unit}]", row.name),
            };
            let limit = row.limit.map(|limit| format!("≤ {}", row.text(limit)));
            write!(
                f,
                "\n{name:<NAME_WIDTH$}{:>CELL_WIDTH$}",
                limit.unwrap_or_default()
            )?;
            for column in &self.columns {
                let value = row.values.get(column).map(|value| row.text(*value));
                let mark = if row.broken.contains(column) { "!" } else { "" };
                let cell = format!("{mark}{}", value.unwrap_or_else(|| "–".to_owned()));
                write!(f, "{cell:>CELL_WIDTH$}")?;
            }
        }
        writeln!(f)
    }
}

impl Row {
    /// Returns the value with its thousands set apart.
    fn text(&self, value: f64) -> String {
        let plain = format!("{value:.*}", self.decimals);
        let whole = plain.split('.').next().unwrap_or(&plain).len();
        let mut text = String::new();
        for (place, digit) in plain.chars().enumerate() {
            let apart = place > 0 && place < whole && (whole - place).is_multiple_of(3);
            if apart && !text.ends_with('-') {
                text.push(',');
            }
            text.push(digit);
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_rows_with_a_limit_can_exceed_it() {
        let mut group = Group::new("cost", ["robot".to_owned(), "other".to_owned()]);
        let own = ["robot".to_owned()];
        group
            .add("update", "instr.", vec![Some(2_001.0), Some(30_000.0)])
            .at_most(2_000.0, &own);
        assert_eq!(group.rows[0].broken, ["robot"]);
        let text = group.to_string();
        assert!(
            text.contains("≤ 2,000") && text.contains("!2,001") && text.contains(" 30,000"),
            "{text}"
        );
    }

    #[test]
    fn a_missing_figure_is_a_dash_and_exceeds_no_limit() {
        let mut group = Group::new("cost", ["a".to_owned()]);
        let columns = group.columns.clone();
        group.add("flash", "KiB", vec![None]).at_most(0.0, &columns);
        assert!(group.rows[0].broken.is_empty());
        assert!(group.to_string().contains('–'));
    }
}
