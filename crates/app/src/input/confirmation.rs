//! SBUS and DBUS have no checksum, and two flipped bits pass a parity check: nothing is believed that one frame alone
//! says, except a stop.

use crate::domain::{DriveMode, OperatorState, RemoteState};

/// Combines each frame with the two before it. Starts with centred sticks, disabled and stopped.
#[derive(Clone, Debug, Default)]
pub(super) struct Confirmation {
    last: [RemoteState; 2],
    last_operator: OperatorState,
    mode: DriveMode,
}

impl Confirmation {
    /// Sticks: the middle one of the last three frames, so that a wrong one never shows and a true one shows one frame
    /// later. Enable, the dead-man stick and the end of an e-stop need two frames in a row, their opposites stop the
    /// robot at once; but the enable switch counts as off, for the next time it goes on, only after two. The mode needs two
    /// equal frames.
    pub fn confirm(
        &mut self,
        state: RemoteState,
        operator: OperatorState,
    ) -> (RemoteState, OperatorState) {
        let [older, last] = self.last;
        let confirmed = RemoteState {
            vx: median(older.vx, last.vx, state.vx),
            wz: median(older.wz, last.wz, state.wz),
            select: median(older.select, last.select, state.select),
            ..state
        };
        if operator.mode == self.last_operator.mode {
            self.mode = operator.mode;
        }
        let confirmed_operator = OperatorState {
            enabled: operator.enabled && self.last_operator.enabled,
            disabled: operator.disabled && self.last_operator.disabled,
            e_stop: operator.e_stop || self.last_operator.e_stop,
            dead_man: operator.dead_man && self.last_operator.dead_man,
            mode: self.mode,
            ..operator
        };
        self.last = [last, state];
        self.last_operator = operator;
        (confirmed, confirmed_operator)
    }
}

fn median(a: f32, b: f32, c: f32) -> f32 {
    a.min(b).max(a.max(b).min(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(
        vx: f32,
        enabled: bool,
        e_stop: bool,
        mode: DriveMode,
    ) -> (RemoteState, OperatorState) {
        let state = RemoteState {
            vx,
            wz: -vx,
            ..RemoteState::default()
        };
        let operator = OperatorState {
            enabled,
            disabled: !enabled,
            e_stop,
            dead_man: false,
            mode,
            ts_us: 0,
        };
        (state, operator)
    }

    fn feed(
        confirmation: &mut Confirmation,
        (state, operator): (RemoteState, OperatorState),
    ) -> (f32, f32, OperatorState) {
        let (state, operator) = confirmation.confirm(state, operator);
        (state.vx, state.wz, operator)
    }

    #[test]
    fn one_wrong_frame_moves_no_stick() {
        let mut confirmation = Confirmation::default();
        let vx: Vec<f32> = [0.4, 0.4, 0.4, -1.0, 0.4, 0.4, 1.0, 0.5, 0.5]
            .map(|vx| feed(&mut confirmation, frame(vx, true, false, DriveMode::Manual)).0)
            .to_vec();
        assert_eq!(vx, [0.0, 0.4, 0.4, 0.4, 0.4, 0.4, 0.4, 0.5, 0.5]);
    }

    #[test]
    fn both_sticks_are_watched() {
        let mut confirmation = Confirmation::default();
        for _ in 0..3 {
            feed(
                &mut confirmation,
                frame(0.25, true, false, DriveMode::Manual),
            );
        }
        let (vx, wz, _) = feed(
            &mut confirmation,
            frame(-0.75, true, false, DriveMode::Manual),
        );
        assert_eq!((vx, wz), (0.25, -0.25));
    }

    #[test]
    fn a_stop_needs_one_frame_and_its_end_two() {
        let mut confirmation = Confirmation::default();
        let stops: Vec<bool> = [false, false, true, false, false]
            .map(|e_stop| {
                feed(
                    &mut confirmation,
                    frame(0.0, true, e_stop, DriveMode::Manual),
                )
                .2
                .e_stop
            })
            .to_vec();
        assert_eq!(stops, [true, false, true, true, false]);
    }

    #[test]
    fn the_dead_man_stick_needs_two_frames_and_its_end_one() {
        let mut confirmation = Confirmation::default();
        let held: Vec<bool> = [true, false, true, true, true, false]
            .map(|dead_man| {
                let (state, operator) = frame(0.0, true, false, DriveMode::Manual);
                let operator = OperatorState {
                    dead_man,
                    ..operator
                };
                feed(&mut confirmation, (state, operator)).2.dead_man
            })
            .to_vec();
        assert_eq!(held, [false, false, false, true, true, false]);
    }

    #[test]
    fn one_wrong_frame_is_no_flick_of_the_selector() {
        let mut confirmation = Confirmation::default();
        let selected: Vec<f32> = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0]
            .map(|select| {
                let (state, operator) = frame(0.0, true, false, DriveMode::Manual);
                let state = RemoteState { select, ..state };
                confirmation.confirm(state, operator).0.select
            })
            .to_vec();
        assert_eq!(selected, [0.0, 0.0, 0.0, 0.0, 1.0, 1.0]);
    }

    #[test]
    fn enable_needs_two_frames_and_its_end_one() {
        let mut confirmation = Confirmation::default();
        let enabled: Vec<bool> = [true, false, true, true, false, true]
            .map(|on| {
                feed(&mut confirmation, frame(0.0, on, false, DriveMode::Manual))
                    .2
                    .enabled
            })
            .to_vec();
        assert_eq!(enabled, [false, false, false, true, false, false]);
    }

    /// One damaged frame while the switch is on must not look like a flip of the switch, nor the first frame after boot.
    #[test]
    fn off_counts_after_two_frames() {
        let mut confirmation = Confirmation::default();
        let off: Vec<bool> = [false, true, false, true, false, false, true]
            .map(|on| {
                feed(&mut confirmation, frame(0.0, on, false, DriveMode::Manual))
                    .2
                    .disabled
            })
            .to_vec();
        assert_eq!(off, [false, false, false, false, false, true, false]);
    }

    #[test]
    fn a_mode_needs_two_equal_frames() {
        use DriveMode::{Custom, Pc};
        let mut confirmation = Confirmation::default();
        let modes: Vec<u8> = [Pc, Pc, Custom, Pc, Custom, Custom]
            .map(|mode| {
                feed(&mut confirmation, frame(0.0, true, false, mode))
                    .2
                    .mode as u8
            })
            .to_vec();
        assert_eq!(modes, [0, 1, 1, 1, 1, 2]);
    }
}
