//! A robot for tests: the firmware's own tuning channel behind a bus that carries other frames and loses some.

use std::{
    cell::RefCell,
    collections::VecDeque,
    rc::Rc,
    time::{Duration, Instant},
};

use robot_app::{
    black_box::BlackBoxMemory,
    bring_up::BringUp,
    diagnostics::DiagnosticsSnapshot,
    domain::{BankStatus, BusId, CanFrame, RobotConfig, StandardId},
    motor::{NotStationary, layout::ROBOT_LAYOUT},
    tuning::{REPLY_ID, Refusal, TuningAccess, TuningChannel, TuningGate, TuningPort, opcode},
};

use super::{Timeouts, TuningClient};
use crate::can_link::{CanLink, CanLinkError};

pub(crate) struct Robot {
    pub channel: TuningChannel,
    pub config: RobotConfig,
    pub gate: TuningGate,
    pub diagnostics: DiagnosticsSnapshot,
    /// The angle at which every joint's motor stands.
    pub standing: Result<f32, NotStationary>,
    /// Everything is saved after this many reads of the store's state.
    pub looks_to_save: Option<usize>,
    /// The firmware is from before there was a store.
    pub is_old: bool,
    pub black_box: Option<&'static BlackBoxMemory>,
    /// A released event is shown for this many more reads of a bank's state; `None` for ever.
    pub looks_to_release: Option<usize>,
    /// Number of frames of the black box that the bus will lose.
    pub block_frames_to_lose: usize,
    /// Number of replies that the bus will lose.
    pub to_lose: usize,
    pub requests: usize,
    pub replies: VecDeque<CanFrame>,
}

impl Robot {
    /// Counts the reads of the store's and a bank's state. After the last one everything is saved, or the bank emptied.
    fn look(&mut self, frame: &CanFrame) {
        match frame.payload().first() {
            Some(&opcode::READ_STORE) => match &mut self.looks_to_save {
                Some(0) => self.diagnostics.params.seen = self.channel.status().revision,
                Some(left) => *left -= 1,
                None => {}
            },
            Some(&opcode::READ_BLACK_BOX) => self.look_at_bank(),
            _ => {}
        }
    }

    fn look_at_bank(&mut self) {
        let [bank, _] = &mut self.diagnostics.black_box.banks;
        let [released, _] = self.channel.status().black_box_released;
        if released == 0 || bank.number != released {
            return;
        }
        match &mut self.looks_to_release {
            Some(0) => *bank = BankStatus::default(),
            Some(left) => *left -= 1,
            None => {}
        }
    }

    /// Sends the block of the black box that was asked for.
    fn send_block(&mut self) {
        let Some(memory) = self.black_box else { return };
        while let Some((_, frame)) = self.channel.block().next(memory) {
            if self.block_frames_to_lose > 0 {
                self.block_frames_to_lose -= 1;
            } else {
                self.replies.push_back(frame);
            }
        }
    }

    /// Returns the firmware's own reply. An old one answers that it does not know the command (docs/tuning.md).
    fn reply(&mut self, frame: &CanFrame) -> Option<CanFrame> {
        if self.is_old
            && let [
                command @ (opcode::READ_STORE
                | opcode::READ_FINDINGS
                | opcode::READ_LIVE
                | opcode::READ_BLACK_BOX),
                ..,
            ] = frame.payload()
        {
            let reason = Refusal::UnknownCommand.code();
            let data = [opcode::REFUSED, *command, reason, 0, 0, 0, 0, 0];
            return Some(CanFrame::new(REPLY_ID, data));
        }
        self.channel.begin_slot();
        let access = TuningAccess {
            config: &mut self.config,
            bring_up: &mut BringUp::default(),
            sensors: &self.diagnostics.sensors,
            diagnostics: &self.diagnostics,
            stationary_angle_rad: &|_| Some(self.standing),
        };
        self.channel
            .on_frame(TuningPort::Bus(BusId::Can2), frame, self.gate, access)
    }
}

#[derive(Clone)]
pub(crate) struct Bus(pub Rc<RefCell<Robot>>);

impl CanLink for Bus {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError> {
        let robot = &mut *self.0.borrow_mut();
        robot.requests += 1;
        robot.look(frame);
        let reply = robot.reply(frame);
        // Traffic of the motors comes first.
        let feedback = StandardId::new(0x201).unwrap();
        robot.replies.push_back(CanFrame::new(feedback, [0x21; 8]));
        if robot.to_lose > 0 {
            robot.to_lose -= 1;
        } else {
            robot.replies.extend(reply);
        }
        robot.send_block();
        Ok(())
    }

    fn receive(&mut self, _: Instant) -> Result<Option<CanFrame>, CanLinkError> {
        Ok(self.0.borrow_mut().replies.pop_front())
    }
}

pub(crate) fn robot() -> (Bus, TuningClient) {
    let bus = Bus(Rc::new(RefCell::new(Robot {
        channel: TuningChannel::new(&ROBOT_LAYOUT),
        diagnostics: DiagnosticsSnapshot::default(),
        standing: Ok(0.75),
        looks_to_save: Some(0),
        is_old: false,
        black_box: None,
        looks_to_release: Some(0),
        block_frames_to_lose: 0,
        config: RobotConfig::default(),
        gate: TuningGate::Open,
        to_lose: 0,
        requests: 0,
        replies: VecDeque::new(),
    })));
    let timeouts = Timeouts {
        each_try: Duration::ZERO,
        tries: 3,
    };
    let client = TuningClient::new(Box::new(bus.clone()), timeouts);
    (bus, client)
}

/// Returns the client of a robot with these diagnostics, over a bus that loses nothing.
pub(crate) fn client(fill: impl FnOnce(&mut DiagnosticsSnapshot)) -> TuningClient {
    let (bus, client) = robot();
    fill(&mut bus.0.borrow_mut().diagnostics);
    client
}
