//! `robotctl blackbox`: downloads the events of the black box, and writes a recording and a page of each.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use robot_app::black_box::BANK_BYTES;
use robotctl::{
    black_box::{self, Bank, RecordedEvent, ReleaseTimeouts},
    plot,
    tuning::TuningClient,
};
use serde_json::json;

use super::{
    connection::{Connection, examples},
    output::say,
};

#[derive(clap::Args)]
#[command(
    after_help = concat!(
        "For each event it writes blackbox-N.mcap and blackbox-N.html, and releases the event afterwards.\n\n",
        examples!("blackbox")
    )
)]
pub struct BlackBox {
    #[command(flatten)]
    connection: Connection,
    /// Folder for the files
    #[arg(long, short, value_name = "FOLDER", default_value = ".")]
    out: PathBuf,
    /// Leave the events in the robot
    #[arg(long)]
    keep: bool,
    /// Print what happened as one line of JSON
    #[arg(long)]
    json: bool,
}

/// An event and where it was written.
struct Written {
    event: RecordedEvent,
    mcap: PathBuf,
    page: PathBuf,
}

impl BlackBox {
    pub fn run(self) -> Result<()> {
        let mut client = self.connection.open()?;
        let (banks, overwritten) = black_box::contents(&mut client)?;
        if let Some(bank) = banks.iter().find(|bank| bank.is_closing) {
            bail!(
                "event {} has just happened and its end is being recorded: try again in a second",
                bank.number
            );
        }
        let mut written = Vec::new();
        for bank in &banks {
            let event = fetch(&mut client, *bank)?;
            written.push(self.write(event)?);
            if !self.keep {
                black_box::release(&mut client, *bank, ReleaseTimeouts::default())?;
            }
        }
        if self.json {
            return print_json(&written, overwritten);
        }
        self.tell(&written, overwritten)
    }

    fn write(&self, event: RecordedEvent) -> Result<Written> {
        std::fs::create_dir_all(&self.out)
            .with_context(|| format!("cannot create the folder {}", self.out.display()))?;
        let mcap = free_name(&self.out, event.event.number);
        let page = mcap.with_extension("html");
        black_box::write(&event, &mcap)?;
        let html = plot::event_page(&event)?;
        std::fs::write(&page, html).with_context(|| format!("cannot write {}", page.display()))?;
        Ok(Written { event, mcap, page })
    }

    fn tell(&self, written: &[Written], overwritten: u8) -> Result<()> {
        for Written { event, mcap, page } in written {
            say!("event {}:", event.event.number)?;
            for text in black_box::paragraphs(event) {
                say!("  {text}")?;
            }
            say!("  written to {} and {}", mcap.display(), page.display())?;
        }
        if written.is_empty() {
            say!(
                "the black box holds no event: since the robot was switched on, or since the last time somebody read it, \
                 nothing stopped it that the pilot had not asked for"
            )?;
        }
        if overwritten > 0 {
            say!(
                "note: {overwritten} older events were overwritten by new drives before anybody read them"
            )?;
        }
        if self.keep && !written.is_empty() {
            say!("kept in the robot; without --keep they are released after reading")?;
        }
        Ok(())
    }
}

fn fetch(client: &mut TuningClient, bank: Bank) -> Result<RecordedEvent> {
    let bar = ProgressBar::new(BANK_BYTES as u64);
    bar.set_style(ProgressStyle::with_template(
        "reading event {msg}  {bar:30} {percent} %",
    )?);
    bar.set_message(bank.number.to_string());
    let event = black_box::download(client, bank, |bytes| bar.set_position(bytes as u64));
    bar.finish_and_clear();
    Ok(event?)
}

/// Numbers begin anew when the robot is switched on, so a file of that name may be there.
fn free_name(folder: &Path, number: u16) -> PathBuf {
    let name = |copy: u32| match copy {
        1 => folder.join(format!("blackbox-{number}.mcap")),
        copy => folder.join(format!("blackbox-{number}-{copy}.mcap")),
    };
    let mut names = (1..).map(name);
    names
        .find(|name| !name.exists() && !name.with_extension("html").exists())
        .unwrap_or_else(|| name(1))
}

fn print_json(written: &[Written], overwritten: u8) -> Result<()> {
    let events: Vec<_> = written
        .iter()
        .map(|Written { event, mcap, page }| {
            let mut summary = black_box::summary(event);
            summary["mcap"] = json!(mcap);
            summary["page"] = json!(page);
            summary
        })
        .collect();
    say!(
        "{}",
        json!({ "events": events, "overwritten": overwritten })
    )?;
    Ok(())
}
