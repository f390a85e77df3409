//! Numbers as the screen shows them.

/// Two decimals with a sign. What rounds to zero is +0.00.
pub fn signed(value: f64) -> String {
    format!("{:+.2}", (value * 100.0).round() / 100.0 + 0.0)
}

#[cfg(test)]
mod tests {
    use super::signed;

    #[test]
    fn a_negative_zero_is_shown_as_zero() {
        let shown = [-0.001, -0.0, 0.016, -1.5].map(signed);
        assert_eq!(shown, ["+0.00", "+0.00", "+0.02", "-1.50"]);
    }
}
