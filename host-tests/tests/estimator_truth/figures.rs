//! Figures against their limits. All are printed before any miss fails the test.

#[derive(Default)]
pub struct Figures {
    missed: Vec<String>,
}

impl Figures {
    /// NaN exceeds every limit.
    pub fn at_most(&mut self, what: &str, got: f64, limit: f64) {
        let held = got <= limit;
        let line = format!("{what}: {got:.4}, at most {limit}");
        println!("{} {line}", if held { "  " } else { "✗ " });
        if !held {
            self.missed.push(line);
        }
    }

    pub fn done(self) {
        assert!(self.missed.is_empty(), "\n{}", self.missed.join("\n"));
    }
}
