//! The page of an event of the black box.

use std::ops::Range;

use robot_app::black_box::BlackBoxSample;
use robot_chart::{ChartError, Figure, document, header, paragraph, table};

use super::series::{Axis, Points, Words, with_gaps, without_wraps};
use crate::{
    black_box::{RecordedEvent, paragraphs},
    link_recorder::Attitude,
};

/// A longer time between two samples is a gap; the older samples are 50 ms apart.
const GAP_S: f64 = 0.12;
const AXES: [&str; 3] = ["x", "y", "z"];
const SIDES: [&str; 2] = ["left", "right"];
const JOINTS: [&str; 4] = ["left front", "left rear", "right front", "right rear"];

/// Returns the page of an event.
pub fn event_page(event: &RecordedEvent) -> Result<String, ChartError> {
    let page = EventPage::new(event);
    let title = format!("Black box, event {}", event.event.number);
    let subtitle = format!(
        "{} samples, {:.2} s before and {:.2} s after the event; the dashed line is the event",
        event.samples.len(),
        -page.axis.time.start,
        page.axis.time.end
    );
    let story: String = paragraphs(event)
        .iter()
        .map(|text| paragraph(text))
        .collect();
    let figures = [
        page.attitude()?,
        page.many("Angular rates", "degrees/s", &AXES, |s| &s.gyro_dps)?,
        page.many("Accelerations", "m/s²", &AXES, |s| &s.accel_mps2)?,
        page.many("Wheel speeds", "rad/s", &SIDES, |s| &s.wheel_rps)?,
        page.currents()?,
        page.many("Joint angles", "rad", &JOINTS, |s| &s.joint_rad)?,
        page.many("Joint torques, as reported", "N·m", &JOINTS, |s| {
            &s.joint_nm
        })?,
        page.command()?,
        page.one("Battery", "V", |s| s.battery_v)?,
        page.ages()?,
    ];
    let figures: String = figures.iter().flatten().map(Figure::html).collect();
    let body = header(&title, &subtitle) + &story + &page.changes() + &figures;
    Ok(document(&title, &body))
}

struct EventPage<'a> {
    event: &'a RecordedEvent,
    axis: Axis,
}

impl<'a> EventPage<'a> {
    fn new(event: &'a RecordedEvent) -> Self {
        let times = || event.samples.iter().map(|sample| event.after_s(sample));
        let start = times().next().unwrap_or(0.0);
        let end = times().next_back().unwrap_or(0.0);
        Self {
            event,
            axis: Axis {
                time: start..end.max(start + 0.01),
                gaps: armed_spans(event),
                marks: vec![0.0],
            },
        }
    }

    fn points(&self, value: impl Fn(&BlackBoxSample) -> f32) -> Points {
        let samples = self.event.samples.iter();
        let points = samples.map(|s| (self.event.after_s(s), Some(f64::from(value(s)))));
        with_gaps(points, GAP_S)
    }

    fn figure(
        &self,
        title: &str,
        unit: &str,
        curves: Vec<(String, Points)>,
    ) -> Result<Option<Figure>, ChartError> {
        let words = Words {
            title,
            caption: "",
            unit,
        };
        self.axis.figure(&words, curves)
    }

    fn one(
        &self,
        title: &str,
        unit: &str,
        value: impl Fn(&BlackBoxSample) -> f32,
    ) -> Result<Option<Figure>, ChartError> {
        self.figure(title, unit, vec![(title.to_owned(), self.points(value))])
    }

    fn many<const N: usize>(
        &self,
        title: &str,
        unit: &str,
        names: &[&str; N],
        values: impl Fn(&BlackBoxSample) -> &[f32; N],
    ) -> Result<Option<Figure>, ChartError> {
        let curves = names.iter().enumerate();
        let curves = curves.map(|(at, name)| ((*name).to_owned(), self.points(|s| values(s)[at])));
        self.figure(title, unit, curves.collect())
    }

    fn attitude(&self) -> Result<Option<Figure>, ChartError> {
        let angle = |of: fn(&Attitude) -> f32| {
            without_wraps(self.points(|s| of(&Attitude::of_wxyz(s.q_wxyz))))
        };
        let curves = vec![
            ("roll".to_owned(), angle(|a| a.roll_deg)),
            ("pitch".to_owned(), angle(|a| a.pitch_deg)),
            ("yaw".to_owned(), angle(|a| a.yaw_deg)),
        ];
        let words = Words {
            title: "Attitude",
            caption: "Dashed line: the event. Tinted: armed.",
            unit: "degrees",
        };
        self.axis.figure(&words, curves)
    }

    fn currents(&self) -> Result<Option<Figure>, ChartError> {
        let curves = vec![
            ("left, sent".to_owned(), self.points(|s| s.sent_ma[0] / 1e3)),
            (
                "right, sent".to_owned(),
                self.points(|s| s.sent_ma[1] / 1e3),
            ),
            (
                "left, measured".to_owned(),
                self.points(|s| s.measured_ma[0] / 1e3),
            ),
            (
                "right, measured".to_owned(),
                self.points(|s| s.measured_ma[1] / 1e3),
            ),
        ];
        self.figure("Wheel currents", "A", curves)
    }

    fn command(&self) -> Result<Option<Figure>, ChartError> {
        let curves = vec![
            ("drive".to_owned(), self.points(|s| 100.0 * s.drive)),
            ("turn".to_owned(), self.points(|s| 100.0 * s.turn)),
        ];
        self.figure("Command", "percent", curves)
    }

    fn ages(&self) -> Result<Option<Figure>, ChartError> {
        let curves = vec![
            (
                "last radio frame".to_owned(),
                self.points(|s| s.radio_age_ms.into()),
            ),
            (
                "last command".to_owned(),
                self.points(|s| s.command_age_ms.into()),
            ),
        ];
        self.figure("Ages, at most 255 ms", "ms", curves)
    }

    fn changes(&self) -> String {
        let rows: Vec<_> = self
            .event
            .changes()
            .into_iter()
            .map(|(at, name, raised)| {
                let what = if raised { "raised" } else { "ended" };
                vec![format!("{name} {what}"), format!("{at:+.2}")]
            })
            .collect();
        if rows.is_empty() {
            return String::new();
        }
        table(&["flag", "s after the event"], &rows)
    }
}

/// The spans in which the robot was armed.
fn armed_spans(event: &RecordedEvent) -> Vec<Range<f64>> {
    let mut spans: Vec<Range<f64>> = Vec::new();
    let mut last = None;
    for sample in &event.samples {
        let at = event.after_s(sample);
        if sample.armed {
            match (spans.last_mut(), last) {
                (Some(span), Some(last)) if span.end == last => span.end = at,
                _ => spans.push(at..at),
            }
        }
        last = Some(at);
    }
    spans
}
