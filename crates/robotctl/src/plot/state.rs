//! The page of the robot's state, as recorded from the PC link.

use robot_chart::{BLUE, ChartError, Figure, GREEN, GREY, Lane, ORANGE, PURPLE, draw_lanes, table};

use super::{
    Content,
    messages::Messages,
    series::{Axis, Points, Words, gaps, with_gaps, without_wraps},
};
use crate::link_recorder::{GAP_S, Joints, LinkCounters, Mode, Motor, STATE_PERIOD_S, State};

/// Width of the bins in which frames are counted.
const RATE_BIN_S: f64 = 0.25;
/// At most this many gaps are listed.
const LISTED_GAPS: usize = 20;

type JointOf = fn(&Joints) -> &Motor;

const JOINTS: [(&str, JointOf); 4] = [
    ("left front", |joints| &joints.left_front),
    ("left rear", |joints| &joints.left_rear),
    ("right front", |joints| &joints.right_front),
    ("right rear", |joints| &joints.right_rear),
];

pub(super) fn content(messages: &Messages) -> Result<Content, ChartError> {
    let page = StatePage::new(messages);
    let figures = [
        page.attitude()?,
        page.vector(
            "Angular rates",
            "Body axes: x forward, y left, z up.",
            "rad/s",
            |s| s.gyro_rps,
        )?,
        page.vector(
            "Accelerations",
            "Specific force in body axes: at rest, z is 9.8.",
            "m/s²",
            |s| s.accel_mps2,
        )?,
        page.wheels()?,
        page.joints("Joint angles", "rad", |joint| joint.angle_rad)?,
        page.joints("Joint speeds", "rad/s", |joint| joint.speed_rps)?,
        page.sticks()?,
        page.lanes()?,
        page.one("Battery", "V", |s| s.battery_v.map(f64::from))?,
        page.one("Temperature of the microcontroller", "°C", |s| {
            Some(s.mcu_c.into())
        })?,
        page.rate()?,
        page.intervals()?,
        page.damage()?,
    ];
    let figures: String = figures.iter().flatten().map(Figure::html).collect();
    Ok(Content {
        summary: page.summary(),
        body: page.numbers() + &figures + &page.gap_table(),
    })
}

struct StatePage<'a> {
    states: &'a [State],
    link: &'a [(f64, LinkCounters)],
    start_s: f64,
    axis: Axis,
}

impl<'a> StatePage<'a> {
    fn new(messages: &'a Messages) -> Self {
        let states = &messages.states;
        let start_s = states.first().map_or(0.0, |state| state.time_s);
        let times = || states.iter().map(|state| state.time_s - start_s);
        let end_s = times().next_back().unwrap_or(0.0).max(STATE_PERIOD_S);
        let changes = states.windows(2).filter_map(|pair| {
            let [before, after] = pair else { return None };
            let changed = before.armed != after.armed || before.mode != after.mode;
            changed.then_some(after.time_s - start_s)
        });
        Self {
            states,
            link: &messages.link,
            start_s,
            axis: Axis {
                time: 0.0..end_s,
                gaps: gaps(times(), GAP_S),
                marks: changes.collect(),
            },
        }
    }

    fn duration_s(&self) -> f64 {
        self.axis.time.end
    }

    fn points(&self, value: impl Fn(&State) -> Option<f64>) -> Points {
        let points = self
            .states
            .iter()
            .map(|state| (state.time_s - self.start_s, value(state)));
        with_gaps(points, GAP_S)
    }

    fn one(
        &self,
        title: &str,
        unit: &str,
        value: impl Fn(&State) -> Option<f64>,
    ) -> Result<Option<Figure>, ChartError> {
        let words = Words {
            title,
            caption: "",
            unit,
        };
        self.axis
            .figure(&words, vec![(title.to_owned(), self.points(value))])
    }

    fn attitude(&self) -> Result<Option<Figure>, ChartError> {
        let words = Words {
            title: "Attitude",
            caption: "Dashed lines: the robot was armed or disarmed, or its mode changed. Tinted: gaps.",
            unit: "degrees",
        };
        let angle = |value: fn(&State) -> f32| {
            without_wraps(self.points(|state| Some(value(state).into())))
        };
        let curves = vec![
            ("roll".to_owned(), angle(|s| s.attitude.roll_deg)),
            ("pitch".to_owned(), angle(|s| s.attitude.pitch_deg)),
            ("yaw".to_owned(), angle(|s| s.attitude.yaw_deg)),
        ];
        self.axis.figure(&words, curves)
    }

    fn vector(
        &self,
        title: &str,
        caption: &str,
        unit: &str,
        value: fn(&State) -> [f32; 3],
    ) -> Result<Option<Figure>, ChartError> {
        let words = Words {
            title,
            caption,
            unit,
        };
        let curves = ["x", "y", "z"].iter().enumerate().map(|(axis, name)| {
            let points = self.points(|state| Some(value(state)[axis].into()));
            ((*name).to_owned(), points)
        });
        self.axis.figure(&words, curves.collect())
    }

    fn wheels(&self) -> Result<Option<Figure>, ChartError> {
        let words = Words {
            title: "Wheel speeds",
            caption: "At the wheel; positive rolls the robot forward.",
            unit: "rad/s",
        };
        let left = self.points(|s| Some(s.wheels.left.speed_rps.into()));
        let right = self.points(|s| Some(s.wheels.right.speed_rps.into()));
        let curves = vec![("left".to_owned(), left), ("right".to_owned(), right)];
        self.axis.figure(&words, curves)
    }

    fn joints(
        &self,
        title: &str,
        unit: &str,
        value: fn(&Motor) -> f32,
    ) -> Result<Option<Figure>, ChartError> {
        let words = Words {
            title,
            caption: "",
            unit,
        };
        let curves = JOINTS.iter().map(|(name, joint)| {
            let points = self.points(|state| Some(value(joint(&state.joints)).into()));
            ((*name).to_owned(), points)
        });
        self.axis.figure(&words, curves.collect())
    }

    fn sticks(&self) -> Result<Option<Figure>, ChartError> {
        let words = Words {
            title: "Sticks",
            caption: "Right and up are positive.",
            unit: "",
        };
        let stick = |value: fn(&State) -> f32| self.points(|state| Some(value(state).into()));
        let curves = vec![
            ("right stick, up".to_owned(), stick(|s| s.radio.ry)),
            ("right stick, right".to_owned(), stick(|s| s.radio.rx)),
            ("left stick, up".to_owned(), stick(|s| s.radio.ly)),
            ("left stick, right".to_owned(), stick(|s| s.radio.lx)),
        ];
        self.axis.figure(&words, curves)
    }

    fn lanes(&self) -> Result<Option<Figure>, ChartError> {
        let lane = |label: &str, colour, is_on: fn(&State) -> bool| {
            let points = self.points(|state| Some(f64::from(u8::from(is_on(state)))));
            Lane::new(label, colour, &points, |value| value > 0.0)
        };
        let lanes = [
            lane("armed", GREEN, |s| s.armed),
            lane("enable switch", GREEN, |s| s.radio.enable),
            lane("mode manual", BLUE, |s| s.mode == Some(Mode::Manual)),
            lane("mode PC", PURPLE, |s| s.mode == Some(Mode::Pc)),
            lane("mode custom", BLUE, |s| s.mode == Some(Mode::Custom)),
            lane("dead-man", GREY, |s| s.radio.dead_man),
            lane("e-stop", ORANGE, |s| s.radio.estop),
            lane("radio lost", ORANGE, |s| s.radio.lost),
        ];
        Ok(Some(Figure {
            title: "States and switches".to_owned(),
            caption: String::new(),
            legend: Vec::new(),
            svg: draw_lanes(&lanes, self.axis.time.clone(), &self.axis.marks)?,
        }))
    }

    fn rate(&self) -> Result<Option<Figure>, ChartError> {
        let mut bins = vec![0.0; (self.duration_s() / RATE_BIN_S) as usize];
        for state in self.states {
            let bin = ((state.time_s - self.start_s) / RATE_BIN_S) as usize;
            if let Some(count) = bins.get_mut(bin) {
                *count += 1.0;
            }
        }
        let points = bins
            .iter()
            .enumerate()
            .map(|(n, count)| ((n as f64 + 0.5) * RATE_BIN_S, Some(count / RATE_BIN_S)));
        let words = Words {
            title: "State frames a second",
            caption: "The robot sends 417 a second, fewer while it answers on the tuning channel.",
            unit: "1/s",
        };
        self.axis
            .figure(&words, vec![("rate".to_owned(), points.collect())])
    }

    fn intervals(&self) -> Result<Option<Figure>, ChartError> {
        let points = self.states.windows(2).filter_map(|pair| {
            let [before, after] = pair else { return None };
            let interval_ms = (after.time_s - before.time_s) * 1e3;
            let is_gap = interval_ms > GAP_S * 1e3;
            let shown = (!is_gap).then_some(interval_ms);
            Some((after.time_s - self.start_s, shown))
        });
        let words = Words {
            title: "Time between state frames",
            caption: "By the robot's clock; gaps are left out.",
            unit: "ms",
        };
        self.axis
            .figure(&words, vec![("interval".to_owned(), points.collect())])
    }

    fn damage(&self) -> Result<Option<Figure>, ChartError> {
        let Some((_, first)) = self.link.first() else {
            return Ok(None);
        };
        let errors = self.link.iter().map(|(t, counters)| {
            let errors = counters.crc_errors.wrapping_sub(first.crc_errors);
            (t - self.start_s, Some(errors.into()))
        });
        let words = Words {
            title: "CRC errors since the start",
            caption: "",
            unit: "",
        };
        self.axis
            .figure(&words, vec![("CRC errors".to_owned(), errors.collect())])
    }

    fn summary(&self) -> String {
        format!(
            "{:.1} s, {} states of the robot, {:.1} a second; the robot's time was {:.1} s at the start",
            self.duration_s(),
            self.states.len(),
            (self.states.len() - 1) as f64 / self.duration_s(),
            self.start_s
        )
    }

    fn numbers(&self) -> String {
        let armed = self.states.iter().filter(|state| state.armed).count();
        let range = |value: &dyn Fn(&State) -> Option<f64>, unit: &str| {
            let values = self.states.iter().filter_map(value);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
            match low <= high {
                true => format!("{low:.1} … {high:.1} {unit}"),
                false => "not measured".to_owned(),
            }
        };
        let counters = self.link.last().map_or(LinkCounters::default(), |l| l.1);
        let missing_s: f64 = self.axis.gaps.iter().map(|gap| gap.end - gap.start).sum();
        let rows = [
            (
                "armed",
                format!("{:.0} %", 100.0 * armed as f64 / self.states.len() as f64),
            ),
            (
                "battery",
                range(&|state| state.battery_v.map(f64::from), "V"),
            ),
            (
                "microcontroller",
                range(&|state| Some(state.mcu_c.into()), "°C"),
            ),
            (
                "gaps",
                match self.axis.gaps.len() {
                    0 => "none".to_owned(),
                    gaps => format!("{gaps}, {missing_s:.2} s in all"),
                },
            ),
            (
                "CRC errors, discarded bytes",
                format!("{}, {}", counters.crc_errors, counters.discarded_bytes),
            ),
        ];
        let rows: Vec<_> = rows
            .into_iter()
            .map(|(name, value)| vec![name.to_owned(), value])
            .collect();
        table(&["over the whole recording", ""], &rows)
    }

    fn gap_table(&self) -> String {
        if self.axis.gaps.is_empty() {
            return String::new();
        }
        let mut longest: Vec<_> = self.axis.gaps.iter().collect();
        longest.sort_by(|a, b| (b.end - b.start).total_cmp(&(a.end - a.start)));
        let rows: Vec<_> = longest
            .iter()
            .take(LISTED_GAPS)
            .map(|gap| {
                vec![
                    format!("{:.3} – {:.3} s", gap.start, gap.end),
                    format!("{:.1}", (gap.end - gap.start) * 1e3),
                ]
            })
            .collect();
        "<h2>Longest gaps</h2>\n".to_owned() + &table(&["from, to", "ms"], &rows)
    }
}
