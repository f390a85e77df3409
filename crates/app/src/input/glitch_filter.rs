//! Rejects single corrupted radio frames.
//!
//! SBUS and DBUS have no checksum, and two flipped bits pass a parity check. A single frame is therefore trusted for
//! one thing only: a stop.

use crate::domain::{DriveMode, OperatorState, RemoteState, StandSwitch};

/// Combines each frame with the two before it. It starts with centred sticks, disabled and with the e-stop set.
#[derive(Clone, Debug, Default)]
pub(super) struct GlitchFilter {
    last: [RemoteState; 2],
    last_operator: OperatorState,
    mode: DriveMode,
    stand: StandSwitch,
}

impl GlitchFilter {
    /// Returns the filtered sticks and switches.
    ///
    /// - Sticks: the median of the last three frames. A single wrong value never shows; a true one shows one frame
    ///   later.
    /// - Enable, the dead-man stick and the release of the e-stop need two equal frames. Their opposites stop the
    ///   robot at once.
    /// - `disabled`, which re-arms the enable switch, needs two frames.
    /// - Mode and stand switch change after two equal frames, and a jump needs two frames.
    pub fn filter(
        &mut self,
        state: RemoteState,
        operator: OperatorState,
    ) -> (RemoteState, OperatorState) {
        let [older, last] = self.last;
        let filtered = RemoteState {
            vx: median(older.vx, last.vx, state.vx),
            wz: median(older.wz, last.wz, state.wz),
            select: median(older.select, last.select, state.select),
            hold: median(older.hold, last.hold, state.hold),
            height: median(older.height, last.height, state.height),
            roll: median(older.roll, last.roll, state.roll),
            ..state
        };
        if operator.mode == self.last_operator.mode {
            self.mode = operator.mode;
        }
        if operator.stand == self.last_operator.stand {
            self.stand = operator.stand;
        }
        let filtered_operator = OperatorState {
            enabled: operator.enabled && self.last_operator.enabled,
            disabled: operator.disabled && self.last_operator.disabled,
            e_stop: operator.e_stop || self.last_operator.e_stop,
            dead_man: operator.dead_man && self.last_operator.dead_man,
            mode: self.mode,
            stand: self.stand,
            jump: operator.jump && self.last_operator.jump,
            ..operator
        };
        self.last = [last, state];
        self.last_operator = operator;
        (filtered, filtered_operator)
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
            ..OperatorState::default()
        };
        (state, operator)
    }

    fn feed(
        glitch_filter: &mut GlitchFilter,
        (state, operator): (RemoteState, OperatorState),
    ) -> (f32, f32, OperatorState) {
        let (state, operator) = glitch_filter.filter(state, operator);
        (state.vx, state.wz, operator)
    }

    #[test]
    fn a_single_wrong_frame_moves_no_stick() {
        let mut glitch_filter = GlitchFilter::default();
        let vx: Vec<f32> = [0.4, 0.4, 0.4, -1.0, 0.4, 0.4, 1.0, 0.5, 0.5]
            .map(|vx| {
                feed(
                    &mut glitch_filter,
                    frame(vx, true, false, DriveMode::Manual),
                )
                .0
            })
            .to_vec();
        assert_eq!(vx, [0.0, 0.4, 0.4, 0.4, 0.4, 0.4, 0.4, 0.5, 0.5]);
    }

    #[test]
    fn both_sticks_are_filtered() {
        let mut glitch_filter = GlitchFilter::default();
        for _ in 0..3 {
            feed(
                &mut glitch_filter,
                frame(0.25, true, false, DriveMode::Manual),
            );
        }
        let (vx, wz, _) = feed(
            &mut glitch_filter,
            frame(-0.75, true, false, DriveMode::Manual),
        );
        assert_eq!((vx, wz), (0.25, -0.25));
    }

    #[test]
    fn an_e_stop_needs_one_frame_and_its_release_two() {
        let mut glitch_filter = GlitchFilter::default();
        let stops: Vec<bool> = [false, false, true, false, false]
            .map(|e_stop| {
                feed(
                    &mut glitch_filter,
                    frame(0.0, true, e_stop, DriveMode::Manual),
                )
                .2
                .e_stop
            })
            .to_vec();
        assert_eq!(stops, [true, false, true, true, false]);
    }

    #[test]
    fn the_dead_man_stick_needs_two_frames_and_its_release_one() {
        let mut glitch_filter = GlitchFilter::default();
        let held: Vec<bool> = [true, false, true, true, true, false]
            .map(|dead_man| {
                let (state, operator) = frame(0.0, true, false, DriveMode::Manual);
                let operator = OperatorState {
                    dead_man,
                    ..operator
                };
                feed(&mut glitch_filter, (state, operator)).2.dead_man
            })
            .to_vec();
        assert_eq!(held, [false, false, false, true, true, false]);
    }

    #[test]
    fn a_single_wrong_frame_does_not_flick_the_left_stick() {
        let mut glitch_filter = GlitchFilter::default();
        let positions: Vec<(f32, f32)> = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0]
            .map(|select| {
                let (state, operator) = frame(0.0, true, false, DriveMode::Manual);
                let state = RemoteState {
                    select,
                    hold: -select,
                    ..state
                };
                let filtered = glitch_filter.filter(state, operator).0;
                (filtered.select, -filtered.hold)
            })
            .to_vec();
        assert_eq!(positions, [0.0, 0.0, 0.0, 0.0, 1.0, 1.0].map(|at| (at, at)));
    }

    #[test]
    fn enable_needs_two_frames_and_disable_one() {
        let mut glitch_filter = GlitchFilter::default();
        let enabled: Vec<bool> = [true, false, true, true, false, true]
            .map(|on| {
                feed(&mut glitch_filter, frame(0.0, on, false, DriveMode::Manual))
                    .2
                    .enabled
            })
            .to_vec();
        assert_eq!(enabled, [false, false, false, true, false, false]);
    }

    /// Neither one damaged frame while the switch is on nor the first frame after boot may look like a flip of the
    /// switch.
    #[test]
    fn the_switch_counts_as_off_after_two_frames() {
        let mut glitch_filter = GlitchFilter::default();
        let off: Vec<bool> = [false, true, false, true, false, false, true]
            .map(|on| {
                feed(&mut glitch_filter, frame(0.0, on, false, DriveMode::Manual))
                    .2
                    .disabled
            })
            .to_vec();
        assert_eq!(off, [false, false, false, false, false, true, false]);
    }

    #[test]
    fn a_mode_change_needs_two_equal_frames() {
        use DriveMode::{Custom, Pc};
        let mut glitch_filter = GlitchFilter::default();
        let modes: Vec<u8> = [Pc, Pc, Custom, Pc, Custom, Custom]
            .map(|mode| {
                feed(&mut glitch_filter, frame(0.0, true, false, mode))
                    .2
                    .mode as u8
            })
            .to_vec();
        assert_eq!(modes, [0, 1, 1, 1, 1, 2]);
    }

    #[test]
    fn the_stand_switch_and_the_jump_button_need_two_equal_frames() {
        use StandSwitch::{Down, Unknown, Up};
        let mut glitch_filter = GlitchFilter::default();
        let mut seen = |stand, jump| {
            let (state, operator) = frame(0.0, true, false, DriveMode::Manual);
            let operator = OperatorState {
                stand,
                jump,
                ..operator
            };
            let filtered = feed(&mut glitch_filter, (state, operator)).2;
            (filtered.stand, filtered.jump)
        };
        assert_eq!(seen(Down, true), (Unknown, false));
        assert_eq!(seen(Down, false), (Down, false));
        assert_eq!(seen(Up, true), (Down, false));
        assert_eq!(seen(Down, true), (Down, true));
        assert_eq!(seen(Up, false), (Down, false));
        assert_eq!(seen(Up, false), (Up, false));
        assert_eq!(seen(Unknown, false), (Up, false));
    }
}
