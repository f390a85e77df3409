//! The page around the plots.

use std::fmt::Write;

use robot_chart::{Figure, escaped};
use robot_plant::time;

use super::{Report, animation};
use crate::{
    budgets::{self, Budget},
    expectation::{Verdict, readable},
    machine::LogLine,
};

const LOG_LINES: usize = 200;

pub fn page(report: &Report, figures: &[Figure]) -> String {
    let parts = [
        header(report),
        numbers(report),
        troubles(report),
        animation::section(report),
        figures.iter().map(Figure::html).collect(),
        expectations(&report.result.verdicts),
        executors(report),
        log_tail(report.traces.log()),
    ];
    robot_chart::document(&report.summary.scenario, &parts.concat())
}

fn header(report: &Report) -> String {
    let summary = report.summary;
    let (class, word) = if summary.ok {
        ("pass", "PASS")
    } else {
        ("fail", "FAIL")
    };
    format!(
        "<header><span class=\"verdict {class}\">{word}</span><div><h1>{name}</h1>\
         <div class=\"soft\">{held} of {all} expectations held · {seconds} s simulated in {wall:.1} s · seed {seed}</div>\
         </div></header>\n",
        name = escaped(&summary.scenario),
        held = summary.expectations - summary.failed_expectations.len(),
        all = summary.expectations,
        seconds = summary.sim_seconds,
        wall = summary.wall.wall_seconds,
        seed = summary.seed,
    )
}

fn numbers(report: &Report) -> String {
    let mut cards = report.summary.budgets.clone();
    // With a PC the run takes as long as the time it simulates.
    if !report.summary.external_input {
        cards.push(budgets::speed_budget(report.summary.wall.realtime_factor));
    }
    let mut html = String::from("<section class=\"numbers\">\n");
    for Budget {
        name,
        limit,
        measured,
        ok,
    } in cards
    {
        let class = if ok { "number" } else { "number over" };
        let _ = writeln!(
            html,
            "<div class=\"{class}\"><span class=\"soft\">{name}</span><b>{measured}</b>\
             <span class=\"soft\">budget {limit}</span></div>"
        );
    }
    for (name, value) in extras(report) {
        let _ = writeln!(
            html,
            "<div class=\"number\"><span class=\"soft\">{name}</span><b>{value}</b></div>"
        );
    }
    html + "</section>\n"
}

/// Numbers without a budget.
fn extras(report: &Report) -> Vec<(&'static str, String)> {
    let summary = report.summary;
    let mut extras = vec![
        ("stack peak", format!("{} bytes", summary.stack_peak_bytes)),
        ("resets", summary.resets.len().to_string()),
    ];
    let gap = summary.control.longest_gap_us;
    let ms = |us: f64| format!("{:.2} ms", us / 1_000.0);
    extras.push(("longest tick gap, armed", ms(gap.armed)));
    extras.push(("longest tick gap, disarmed", ms(gap.disarmed)));
    if summary.flash.erases + summary.flash.programs > 0 {
        let (erases, words) = (summary.flash.erases, summary.flash.programs);
        extras.push(("flash", format!("{erases} erases, {words} words")));
    }
    if let Some(error) = &summary.attitude_error {
        for (label, rmse_deg) in [
            ("attitude error, RMSE", error.total_rmse_deg),
            ("heading error, RMSE", error.heading_rmse_deg),
            ("inclination error, RMSE", error.inclination_rmse_deg),
        ] {
            extras.push((label, format!("{rmse_deg:.2}°")));
        }
    }
    extras
}

fn troubles(report: &Report) -> String {
    let summary = report.summary;
    let stopped = summary
        .stopped
        .iter()
        .map(|why| format!("stopped at {:.4} s: {why}", summary.sim_seconds));
    let errors = summary
        .board_errors
        .iter()
        .map(|e| format!("board error at {:.4} s ({}×): {}", e.at, e.count, e.message));
    let wrong = stopped.chain(errors).map(|text| ("wrong", text));
    let doubts = summary
        .suspicions
        .iter()
        .map(|e| format!("suspicious at {:.4} s ({}×): {}", e.at, e.count, e.message))
        .map(|text| ("doubt", text));
    wrong
        .chain(doubts)
        .map(|(class, text)| format!("<div class=\"{class}\">{}</div>\n", escaped(&text)))
        .collect()
}

fn expectations(verdicts: &[Verdict]) -> String {
    if verdicts.is_empty() {
        return String::new();
    }
    let mut html = String::from(
        "<h2>Expectations</h2>\n<table>\n<tr><th></th><th>signal</th><th>expected</th>\
         <th>window</th><th>decided by</th><th>because</th></tr>\n",
    );
    for verdict in verdicts {
        let (class, mark) = match verdict.failure {
            None => ("held", "✓"),
            Some(_) => ("failed", "✗"),
        };
        let window = format!(
            "{} – {} s",
            time::to_seconds(verdict.window.start),
            time::to_seconds(verdict.window.end)
        );
        let decided = match (&verdict.failure, verdict.decisive) {
            (Some(why), _) => escaped(why),
            (None, Some(r)) => format!("{} at {:.3} s", readable(r.value), time::to_seconds(r.at)),
            (None, None) => String::new(),
        };
        let _ = writeln!(
            html,
            "<tr><td class=\"{class}\">{mark}</td><td>{}</td><td>{}</td>\
             <td class=\"n\">{window}</td><td>{decided}</td><td class=\"soft\">{}</td></tr>",
            escaped(&verdict.signal),
            escaped(&verdict.expected),
            escaped(verdict.because.as_deref().unwrap_or_default()),
        );
    }
    html + "</table>\n"
}

fn executors(report: &Report) -> String {
    if report.summary.executors.is_empty() {
        return String::new();
    }
    let mut html = String::from(
        "<h2>Where the instructions go</h2>\n<table>\n<tr><th>context</th><th>share</th></tr>\n",
    );
    for (name, share) in &report.summary.executors {
        let _ = writeln!(
            html,
            "<tr><td>{}</td><td class=\"n\">{:.2} %</td></tr>",
            escaped(name),
            share * 100.0
        );
    }
    html + "</table>\n"
}

fn log_tail(log: &[LogLine]) -> String {
    let skipped = log.len().saturating_sub(LOG_LINES);
    let mut html = format!(
        "<h2>Firmware log</h2>\n<div class=\"soft\">{} lines{}</div>\n<pre>",
        log.len(),
        if skipped > 0 {
            format!(", the last {LOG_LINES} shown")
        } else {
            String::new()
        }
    );
    for line in log.iter().skip(skipped) {
        let level = line.level.to_uppercase();
        let _ = writeln!(
            html,
            "{:>11.6} <span class=\"{level}\">{level:<5}</span> {}",
            time::to_seconds(line.at),
            escaped(&line.text)
        );
    }
    html + "</pre>\n"
}
