//! One question on the line, and what is heard until its answers are complete or late.

use std::time::Duration;

use super::{
    Alarms, Cause, ServoBus, WireError,
    frame::{self, Frame, Instruction, answer_size},
    parser::Found,
};

/// After damage the answers that are left are waited for by their own time and this much.
const GRACE: Duration = Duration::from_millis(2);
/// After a late or damaged answer nothing is sent before the line has been silent for so long,
const QUIET: Duration = Duration::from_millis(1);
/// but a line that is never silent is not waited for.
const LONGEST_SETTLE: Duration = Duration::from_millis(50);

/// What is asked of one or more servos.
#[derive(Clone, Copy, Debug)]
pub(super) enum Question<'a> {
    Read {
        address: u8,
        size: u8,
    },
    SyncRead {
        address: u8,
        size: u8,
    },
    /// Anything that is answered without data.
    Do(Instruction, &'a [u8]),
}

impl Question<'_> {
    /// Returns the request, with so many bytes more to read than are wanted. `None` if it is too long.
    fn request(&self, ids: &[u8], more: u8) -> Option<Vec<u8>> {
        let first = *ids.first()?;
        match *self {
            Self::Read { address, size } => frame::request(
                first,
                Instruction::Read,
                &[address, size.checked_add(more)?],
            ),
            Self::SyncRead { address, size } => {
                let mut parameters = vec![address, size.checked_add(more)?];
                parameters.extend(ids);
                frame::request(frame::BROADCAST, Instruction::SyncRead, &parameters)
            }
            Self::Do(instruction, parameters) => frame::request(first, instruction, parameters),
        }
    }

    fn size(&self) -> u8 {
        match *self {
            Self::Read { size, .. } | Self::SyncRead { size, .. } => size,
            Self::Do(..) => 0,
        }
    }

    pub(super) fn is_read(&self) -> bool {
        !matches!(self, Self::Do(..))
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Answer {
    pub(super) alarms: Alarms,
    pub(super) data: Vec<u8>,
}

/// What one exchange brought.
#[derive(Debug, Default)]
pub(super) struct Heard {
    /// In the order of the servos that were asked.
    pub(super) answers: Vec<Option<Answer>>,
    pub(super) has_echo: bool,
    is_damaged: bool,
    other_servo: Option<u8>,
    other_length: Option<(u8, usize)>,
}

impl Heard {
    /// Returns why a servo's answer is missing.
    pub(super) fn cause(&self, id: u8, wanted: usize) -> Cause {
        match (self.other_length, self.other_servo) {
            (Some((other, came)), _) if other == id => Cause::OtherLength { wanted, came },
            _ if self.is_damaged => Cause::Damaged,
            (_, Some(id)) => Cause::OtherServo { id },
            _ => Cause::NoAnswer,
        }
    }

    fn is_complete(&self) -> bool {
        // Servos answer in the order in which they are asked: after the last one none will.
        matches!(self.answers.last(), Some(Some(_)))
    }
}

/// What is waited for.
struct Awaited<'a> {
    request: Vec<u8>,
    ids: &'a [u8],
    data: usize,
}

impl Awaited<'_> {
    /// True for an answer, and for a copy of the request.
    fn takes(&self, frame: &Frame) -> bool {
        let is_answer = self.ids.contains(&frame.id()) && frame.data().len() == self.data;
        is_answer || frame.bytes() == self.request
    }
}

impl ServoBus {
    /// Asks once. `None` if the question does not fit into a frame.
    pub(super) fn exchange(
        &mut self,
        question: &Question,
        ids: &[u8],
    ) -> Result<Option<Heard>, WireError> {
        let more = self.extra_bytes(question, ids);
        let Some(request) = question.request(ids, more) else {
            return Ok(None);
        };
        let data = usize::from(question.size()) + usize::from(more);
        self.listen_until(Duration::ZERO)?;
        self.parser.restart(request.len().max(answer_size(data)));
        self.wire.send(&request)?;
        self.statistics.sent += 1;
        let awaited = Awaited { request, ids, data };
        let mut heard = self.hear(&awaited)?;
        for (id, answer) in ids.iter().zip(&mut heard.answers) {
            let Some(answer) = answer else { continue };
            self.statistics.answered += 1;
            answer.data.truncate(question.size().into());
            self.silent.remove(id);
            if question.is_read() {
                self.unsettled.remove(id);
            }
        }
        if heard.answers.iter().any(Option::is_none) {
            self.note_missing(ids, &heard);
            self.settle()?;
        }
        Ok(Some(heard))
    }

    /// A servo whose last answer is missing may still send it. It is therefore asked for a few bytes more than before: the late
    /// answer has another length. Its next answer proves that nothing older is on its way, as a servo answers in order.
    fn extra_bytes(&self, question: &Question, ids: &[u8]) -> u8 {
        let is_unsettled = ids.iter().any(|id| self.unsettled.contains(id));
        if question.is_read() && is_unsettled {
            self.extra
        } else {
            0
        }
    }

    fn note_missing(&mut self, ids: &[u8], heard: &Heard) {
        self.extra = self.extra % 7 + 1;
        for (id, answer) in ids.iter().zip(&heard.answers) {
            if answer.is_none() {
                self.statistics.missing += 1;
                self.unsettled.insert(*id);
            }
        }
    }

    fn hear(&mut self, awaited: &Awaited) -> Result<Heard, WireError> {
        let mut heard = Heard {
            answers: vec![None; awaited.ids.len()],
            ..Heard::default()
        };
        let took = self.timing.of_bytes(awaited.request.len())
            + self.timing.answers(awaited.ids, awaited.data);
        let mut deadline = self.wire.now() + took + self.timing.host_slack;
        let mut buffer = [0; 256];
        loop {
            let count = self.wire.receive(&mut buffer, deadline)?;
            let bytes = buffer.get(..count).unwrap_or_default();
            for &byte in bytes {
                self.parser.push(byte);
                self.take_found(awaited, &mut heard);
            }
            if heard.is_complete() {
                break;
            }
            if count == 0 && self.wire.now() >= deadline {
                while self.parser.give_up() {
                    self.take_found(awaited, &mut heard);
                }
                break;
            }
            if heard.is_damaged {
                let left = self.timing.answers(awaited.ids, awaited.data);
                deadline = deadline.min(self.wire.now() + left + GRACE);
            }
        }
        self.parser.restart(frame::longest());
        self.statistics.stray_bytes = self.parser.skipped() + self.unasked_bytes;
        Ok(heard)
    }

    fn take_found(&mut self, awaited: &Awaited, heard: &mut Heard) {
        let is_wanted = |frame: &Frame| awaited.takes(frame);
        while let Some(found) = self.parser.next(is_wanted) {
            match found {
                Found::Frame(frame) => self.take_frame(&frame, awaited, heard),
                Found::Damaged => {
                    self.statistics.damaged += 1;
                    heard.is_damaged = true;
                }
            }
        }
    }

    fn take_frame(&mut self, frame: &Frame, awaited: &Awaited, heard: &mut Heard) {
        if frame.bytes() == awaited.request && !heard.has_echo {
            self.statistics.echoes += 1;
            heard.has_echo = true;
            return;
        }
        let (id, data) = (frame.id(), frame.data());
        let place = awaited.ids.iter().position(|asked| *asked == id);
        let Some(answer) = place.and_then(|place| heard.answers.get_mut(place)) else {
            self.statistics.alien += 1;
            heard.other_servo = Some(id);
            return;
        };
        let Some(alarms) = Alarms::from_byte(frame.status()) else {
            self.statistics.damaged += 1;
            heard.is_damaged = true;
            return;
        };
        if data.len() != awaited.data {
            self.statistics.other_length += 1;
            heard.other_length = Some((id, data.len()));
        } else if answer.is_some() {
            self.statistics.alien += 1;
        } else {
            let data = data.to_vec();
            *answer = Some(Answer { alarms, data });
        }
    }

    /// Ends frames that servos wait for. A servo that heard a damaged length takes all that follows for a part of that frame: up to
    /// 255 bytes, and so many tries. Zeros complete it, and never with a right checksum: a request whose length is `k` too large
    /// needs `k · (filler + 1)` to be a multiple of 256.
    pub(super) fn free_receivers(&mut self) -> Result<(), WireError> {
        let zeros = [0; 255];
        self.wire.send(&zeros)?;
        let sent = self.wire.now() + self.timing.of_bytes(zeros.len());
        self.listen_until(sent)?;
        self.settle()
    }

    /// Waits until the line is silent, so that the rest of a late answer does not damage the next.
    fn settle(&mut self) -> Result<(), WireError> {
        let end = self.wire.now() + LONGEST_SETTLE;
        let mut buffer = [0; 256];
        while self.wire.now() < end {
            let until = self.wire.now() + QUIET;
            match self.wire.receive(&mut buffer, until)? {
                0 => break,
                count => self.count_unasked(count),
            }
        }
        Ok(())
    }

    /// Drops what comes until a moment on the wire's clock; zero drops what is there.
    pub(super) fn listen_until(&mut self, moment: Duration) -> Result<(), WireError> {
        let mut buffer = [0; 256];
        let mut left = LONGEST_BURST;
        loop {
            let count = self.wire.receive(&mut buffer, moment)?;
            self.count_unasked(count);
            left = left.saturating_sub(count);
            if (count == 0 && self.wire.now() >= moment) || left == 0 {
                return Ok(());
            }
        }
    }

    fn count_unasked(&mut self, count: usize) {
        self.unasked_bytes += count as u64;
        self.statistics.stray_bytes = self.parser.skipped() + self.unasked_bytes;
    }
}

/// A device that never stops sending is not drained for ever.
const LONGEST_BURST: usize = 65_536;
