use super::*;

fn error(text: &str) -> (usize, String) {
    let error = read(text.as_bytes(), Sensor::Accelerometer).unwrap_err();
    (error.line, error.why.to_string())
}

#[test]
fn columns_are_found_by_name_in_any_order() {
    let text = "# board 7\nmy, t ,mx,gap,mz\n\n2,0.5,1,9,-3e1\n";
    let table = read(text.as_bytes(), Sensor::Magnetometer).unwrap();
    let value = Vector3::new(1.0, 2.0, -30.0);
    assert_eq!(table.samples, [Sample { t_s: 0.5, value }]);
}

#[test]
fn a_wrong_line_is_named() {
    let (line, why) = error("t,ax,ay\n");
    assert_eq!(line, 1);
    assert!(why.contains("`az`") && why.contains("t,ax,ay,az"), "{why}");
    assert_eq!(error("t,ax,ay,az\n0,1,2,3\n1,2,nan,4\n").0, 3);
    assert_eq!(error("t,ax,ay,az\n0,1,2\n").0, 2);
    assert_eq!(error("t,ax,ay,az\n1,0,0,9\n0.5,0,0,9\n").0, 3);
}

/// A recording as another program might export it: 40 rows at 50 Hz, with the robot flat on the table.
struct Export {
    header: &'static str,
    separator: &'static str,
    decimal_comma: bool,
    line_end: &'static str,
    begin: &'static str,
    time_factor: f64,
    factor: f64,
}

const PLAIN: Export = Export {
    header: "t ax ay az",
    separator: ",",
    decimal_comma: false,
    line_end: "\n",
    begin: "",
    time_factor: 1.0,
    factor: 1.0,
};

impl Export {
    fn text(&self) -> String {
        let mut text = self.begin.to_owned();
        text.push_str(&self.header.replace(' ', self.separator));
        for row in 0..40 {
            let t = f64::from(row) * 0.02 * self.time_factor;
            let numbers = [t, 0.5 * self.factor, 0.0, 9.79 * self.factor];
            let fields = numbers.map(|number| {
                let text = format!("{number:.5}");
                if self.decimal_comma {
                    text.replace('.', ",")
                } else {
                    text
                }
            });
            text.push_str(self.line_end);
            text.push_str(&fields.join(self.separator));
        }
        text
    }

    /// Returns the notes, after a check that the samples are right.
    fn read(&self) -> Vec<String> {
        let table = read(self.text().as_bytes(), Sensor::Accelerometer).unwrap();
        assert_eq!(table.samples.len(), 40);
        let Sample { t_s, value } = table.samples[39];
        assert!((t_s - 0.78).abs() < 1e-6, "{t_s}");
        assert!(
            (value - Vector3::new(0.5, 0.0, 9.79)).norm() < 1e-3,
            "{value}"
        );
        table.notes
    }

    fn refused(&self) -> String {
        error(&self.text()).1
    }
}

#[test]
fn tables_of_other_programs_are_read() {
    const G: f64 = 1.0 / 9.806_65;
    let none: [String; 0] = [];
    let plain = [
        PLAIN,
        Export {
            line_end: "\r\n",
            ..PLAIN
        },
        Export {
            begin: "\u{feff}",
            ..PLAIN
        },
        Export {
            separator: ";",
            ..PLAIN
        },
        Export {
            separator: ";",
            decimal_comma: true,
            ..PLAIN
        },
        Export {
            separator: "\t",
            ..PLAIN
        },
        Export {
            separator: "\t",
            decimal_comma: true,
            line_end: "\r\n",
            ..PLAIN
        },
        Export {
            separator: " , ",
            ..PLAIN
        },
        Export {
            header: "T AX AY AZ",
            ..PLAIN
        },
        Export {
            header: "Time Acc_X Acc_Y Acc_Z",
            ..PLAIN
        },
        Export {
            header: "\"timestamp\" \"accel.x\" \"accel.y\" \"accel.z\"",
            ..PLAIN
        },
        Export {
            header: "t_ms ax_g ay_g az_g",
            time_factor: 1e3,
            factor: G,
            ..PLAIN
        },
        Export {
            header: "t[us] ax(mg) ay(mg) az(mg)",
            time_factor: 1e6,
            factor: G * 1e3,
            ..PLAIN
        },
        Export {
            header: "time(s) ax[m/s^2] ay[m/s^2] az[m/s^2]",
            separator: ";",
            ..PLAIN
        },
    ];
    for export in plain {
        assert_eq!(export.read(), none);
    }
    let taken = Export { factor: G, ..PLAIN }.read();
    assert_eq!(taken, ["values are in g"]);
    let taken = Export {
        factor: G * 1e3,
        ..PLAIN
    }
    .read();
    assert_eq!(taken, ["values are in mg"]);
    let taken = Export {
        time_factor: 1e3,
        ..PLAIN
    }
    .read();
    assert_eq!(taken, ["time is in milliseconds"]);
    let taken = Export {
        time_factor: 1e6,
        ..PLAIN
    }
    .read();
    assert_eq!(taken, ["time is in microseconds"]);
    let taken = Export {
        time_factor: 1e9,
        ..PLAIN
    }
    .read();
    assert_eq!(taken, ["time is in nanoseconds"]);
}

#[test]
fn doubtful_tables_are_refused_with_the_cause() {
    for (export, cause) in [
        // 1 a row: 1 s, or 1 ms?
        (
            Export {
                time_factor: 50.0,
                ..PLAIN
            },
            "`t_ms` or `t_us`",
        ),
        (
            Export {
                time_factor: 0.0,
                ..PLAIN
            },
            "time of the row before",
        ),
        (
            Export {
                factor: 0.5,
                ..PLAIN
            },
            "raw counts",
        ),
        (
            Export {
                factor: 2_048.0,
                ..PLAIN
            },
            "raw counts",
        ),
        (
            Export {
                decimal_comma: true,
                ..PLAIN
            },
            "decimal commas",
        ),
        (
            Export {
                header: "t x y z",
                ..PLAIN
            },
            "no column `ax` among t, x, y, z",
        ),
        (
            Export {
                header: "n ax ay az",
                ..PLAIN
            },
            "no column `t`",
        ),
        (
            Export {
                header: "0 1 2 9.8",
                ..PLAIN
            },
            "columns' names",
        ),
        (
            Export {
                header: "t ax[ft/s2] ay az",
                ..PLAIN
            },
            "`ft/s2`",
        ),
        (
            Export {
                header: "t ax_g ay az",
                ..PLAIN
            },
            "some have none",
        ),
        (
            Export {
                separator: "  ",
                ..PLAIN
            },
            "one column only",
        ),
    ] {
        let why = export.refused();
        assert!(why.contains(cause), "`{cause}` in: {why}");
    }
}

#[test]
fn units_of_a_compass_are_recognised_by_the_earths_field() {
    let table = |factor: f64| {
        let mut text = String::from("t,mx,my,mz\n");
        for row in 0..40 {
            let t = f64::from(row) * 0.02;
            text.push_str(&format!("{t},{},{},0\n", 30.0 * factor, -40.0 * factor));
        }
        read(text.as_bytes(), Sensor::Magnetometer).unwrap()
    };
    for (factor, note) in [
        (1.0, None),
        (0.01, Some("gauss")),
        (1_000.0, Some("nanotesla")),
    ] {
        let Table { samples, notes } = table(factor);
        assert!((samples[3].value - Vector3::new(30.0, -40.0, 0.0)).norm() < 1e-9);
        let expected: Vec<String> = note
            .map(|unit| format!("values are in {unit}"))
            .into_iter()
            .collect();
        assert_eq!(notes, expected);
    }
}

/// `robotctl record` writes such rows, because the magnetometer measures less often.
#[test]
fn rows_without_the_sensor_are_ignored() {
    let text =
        "t,ax,ay,az,gx,gy,gz,mx,my,mz\n0,1,2,9,0,0,0,,,\n0.002,,,,,,,20,0,-40\n0.005,1,2,8,,,,,,\n";
    let count = |sensor| read(text.as_bytes(), sensor).unwrap().samples.len();
    assert_eq!(count(Sensor::Accelerometer), 2);
    assert_eq!(count(Sensor::Magnetometer), 1);
    let (line, _) = error("t,ax,ay,az\n0,1,2,9\n0.1,,2,9\n");
    assert_eq!(line, 3);
}
