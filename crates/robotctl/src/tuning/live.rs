//! The robot's live values (docs/tuning.md, `33`).

use robot_app::{
    domain::CanFrame,
    tuning::{LIVE_PAGES, LiveKind, LivePage, LiveValue},
};

use super::request::{Reply, Request};

/// A page as the robot showed it at one moment.
#[derive(Clone, Copy, Debug)]
pub struct LiveReading {
    pub page: &'static LivePage,
    /// Index into `page.parts`.
    pub part: usize,
    bytes: [u8; 6],
}

/// Returns the page with this name.
///
/// # Panics
/// If there is none: names of pages and fields are constants of the caller.
pub fn live_page(name: &str) -> &'static LivePage {
    let found = LIVE_PAGES.iter().find(|page| page.name == name);
    found.unwrap_or_else(|| panic!("there is no live page `{name}`"))
}

/// A request for a page that is sent and answered without waiting. The robot may be armed.
#[derive(Clone, Copy, Debug)]
pub struct LiveQuestion {
    page: &'static LivePage,
    request: Request,
}

impl LiveQuestion {
    /// A question for a page about the whole robot.
    ///
    /// # Panics
    /// If there is no such page.
    pub fn new(name: &str) -> Self {
        let page = live_page(name);
        Self {
            page,
            request: Request::ReadLive(page.first),
        }
    }

    pub fn frame(&self) -> CanFrame {
        self.request.frame()
    }

    /// Returns what the robot answers, or `None` if `frame` is no answer to this question or the firmware does not have
    /// the page.
    pub fn answer(&self, frame: &CanFrame) -> Option<LiveReading> {
        match self.request.reply(frame)? {
            Reply::Done(bytes) => Some(LiveReading::new(self.page, 0, bytes)),
            Reply::Refused(_) => None,
        }
    }
}

impl LiveReading {
    /// Parses the bytes after the command. The first is the page's number.
    pub(super) fn new(
        page: &'static LivePage,
        part: usize,
        [_, a, b, c, d, e, f]: [u8; 7],
    ) -> Self {
        let bytes = [a, b, c, d, e, f];
        Self { page, part, bytes }
    }

    /// Returns the name of the page and, if it has several parts, of the part.
    pub fn title(&self) -> String {
        match self.page.parts.get(self.part) {
            None | Some(&"") => self.page.name.to_owned(),
            Some(part) => format!("{} {part}", self.page.name),
        }
    }

    /// # Panics
    /// If the page has no such field.
    pub fn value(&self, field: &str) -> LiveValue {
        let mut fields = self.page.unpack(self.bytes);
        match fields.find(|(known, _)| known.name == field) {
            Some((_, value)) => value,
            None => panic!("page `{}` has no field `{field}`", self.page.name),
        }
    }

    /// Returns a number in its unit, or `None` if the robot does not know it.
    ///
    /// # Panics
    /// If the page has no such field, or it is no number.
    pub fn number(&self, field: &str) -> Option<f64> {
        match self.value(field) {
            LiveValue::Count(count) => Some(count.into()),
            LiveValue::Measure(measured) => measured,
            other => panic!("`{field}` is no number: {other:?}"),
        }
    }

    /// Returns a choice by the firmware's name.
    ///
    /// # Panics
    /// If the page has no such field, or it is no choice.
    pub fn choice(&self, field: &str) -> String {
        match self.value(field) {
            LiveValue::Choice(Ok(name)) => name.to_owned(),
            LiveValue::Choice(Err(number)) => unknown("number", number),
            other => panic!("`{field}` is no choice: {other:?}"),
        }
    }

    /// Returns the names of a set's members, lowest bit first.
    ///
    /// # Panics
    /// If the page has no such field, or it is no set.
    pub fn set(&self, field: &str) -> Vec<String> {
        let named = self.page.fields.iter().find(|known| known.name == field);
        let (Some(LiveKind::Set { name_of, .. }), LiveValue::Set(bits)) =
            (named.map(|field| &field.kind), self.value(field))
        else {
            panic!("`{field}` is no set");
        };
        let set = (0..32).filter(|bit| bits & 1 << bit != 0);
        let name = |bit: u8| match name_of(bit) {
            Some(name) => name.to_owned(),
            None => unknown("bit", bit.into()),
        };
        set.map(name).collect()
    }

    /// True if `member` is in a set.
    ///
    /// # Panics
    /// Panics where [`set`](Self::set) does.
    pub fn has(&self, field: &str, member: &str) -> bool {
        self.set(field).iter().any(|name| name == member)
    }

    /// Returns all values of the page with their names.
    pub fn values(&self) -> impl Iterator<Item = (&'static str, LiveValue)> {
        let fields = self.page.unpack(self.bytes);
        fields.map(|(field, value)| (field.name, value))
    }
}

fn unknown(what: &str, number: u32) -> String {
    format!("{what} {number} (newer than this robotctl)")
}
