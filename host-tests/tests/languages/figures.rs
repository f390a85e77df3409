//! The figures of a text, each with its unit, and the names that have a digit in them.

/// What may follow a number as its unit; where one begins another, the longer comes first.
const UNITS: [&str; 50] = [
    "N·m·s/rad",
    "N·m/rad",
    "N·m",
    "mN·m",
    "m/s²",
    "m/s",
    "rad/s",
    "rad",
    "deg/s",
    "deg",
    "rpm",
    "°/s",
    "°C",
    "°",
    "%",
    "ms",
    "µs",
    "us",
    "ns",
    "min",
    "s",
    "h",
    "kHz",
    "MHz",
    "Hz",
    "mA",
    "µA",
    "A",
    "mV",
    "V",
    "kΩ",
    "Ω",
    "mm",
    "cm",
    "µm",
    "m",
    "kg",
    "g",
    "KiB",
    "MiB",
    "GiB",
    "kB",
    "MB",
    "Mb/s",
    "kbit/s",
    "µT",
    "K",
    "mW",
    "W",
    "T",
];

/// Figures and names of the text in order, all figures in one notation: no thousands separator, the
/// sign is `-`, one space before the unit. `4 bytes` gives `4`; `an M3508 at 1,200 rpm` gives `M3508`
/// and `1200 rpm`.
pub fn figures(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut before = ' ';
    let mut before_that = ' ';
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if first.is_ascii_digit() {
            let number = number_length(rest);
            let hexadecimal = rest.starts_with("0x");
            let unit = if hexadecimal {
                ""
            } else {
                unit(&rest[number..])
            };
            let sign = sign(before, before_that);
            let digits = rest[..number].replace(',', "");
            found.push(format!("{sign}{digits} {unit}").trim_end().to_owned());
            number
        } else if first.is_ascii_alphabetic() {
            let word = length_while(rest, |letter| {
                letter.is_ascii_alphanumeric() || letter == '_'
            });
            if rest[..word].contains(|letter: char| letter.is_ascii_digit()) {
                found.push(rest[..word].to_owned());
            }
            word
        } else {
            first.len_utf8()
        };
        for passed in rest[..length].chars() {
            before_that = before;
            before = passed;
        }
        rest = &rest[length..];
    }
    found
}

fn length_while(text: &str, belongs: impl Fn(char) -> bool) -> usize {
    text.find(|letter| !belongs(letter)).unwrap_or(text.len())
}

/// How many bytes the number at the start takes: `0x7A0`, or digits with `,` before each three of
/// them and one decimal point.
fn number_length(text: &str) -> usize {
    if let Some(digits) = text.strip_prefix("0x") {
        return 2 + length_while(digits, |digit| digit.is_ascii_hexdigit());
    }
    let digits = |from: usize| length_while(&text[from..], |digit| digit.is_ascii_digit());
    let mut length = digits(0);
    while text[length..].starts_with(',') && digits(length + 1) == 3 {
        length += 4;
    }
    if text[length..].starts_with('.') && digits(length + 1) > 0 {
        length += 1 + digits(length + 1);
    }
    length
}

/// The unit at the start, after one space at most; empty if there is none.
fn unit(text: &str) -> &'static str {
    let text = text.strip_prefix([' ', '\u{a0}']).unwrap_or(text);
    let part_of_more = |letter: char| letter.is_ascii_alphanumeric() || "/·²".contains(letter);
    let is_unit = |unit: &&str| match text.strip_prefix(unit) {
        Some(rest) => !rest.starts_with(part_of_more),
        None => false,
    };
    UNITS.into_iter().find(is_unit).unwrap_or("")
}

/// A dash between two words is none.
fn sign(before: char, before_that: char) -> &'static str {
    match before {
        '±' => "±",
        '-' | '−' if !before_that.is_alphanumeric() => "-",
        _ => "",
    }
}

#[test]
fn figures_have_one_notation() {
    let same = ["at most 1,943 µs, −0.5 N·m", "最多 1943µs，-0.5 N·m"];
    for text in same {
        assert_eq!(figures(text), ["1943 µs", "-0.5 N·m"], "{text}");
    }
}

#[test]
fn a_unit_belongs_to_its_figure() {
    let text = "±500 mN·m, 5 N·m/rad, 1/256 m/s², 54 %, 30°, 1.6° off, 20 KiB";
    let expected = [
        "±500 mN·m",
        "5 N·m/rad",
        "1",
        "256 m/s²",
        "54 %",
        "30 °",
        "1.6 °",
        "20 KiB",
    ];
    assert_eq!(figures(text), expected);
    assert_eq!(
        figures("2 sensors, 3 mm. 4. A 11-bit number, 0.1s"),
        ["2", "3 mm", "4", "11", "0.1 s"]
    );
    assert_eq!(figures("4 秒、5 ms内"), ["4", "5 ms"]);
}

#[test]
fn names_and_lists_are_no_thousands() {
    let text = "CAN1: 0x7A0, 0x7A2 A; M3508和RS00, 172, 992, 1,811,000 (version 0.28)";
    let expected = [
        "CAN1", "0x7A0", "0x7A2", "M3508", "RS00", "172", "992", "1811000", "0.28",
    ];
    assert_eq!(figures(text), expected);
}
