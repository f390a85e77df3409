//! Which servos are plugged in: new ones all have the same id, so one is set up after the other.

use robot_servo_model::{Bus, Fault, FaultId};

/// Servos of an arm.
const SERVOS: usize = 6;

/// The servos that are not plugged in.
#[derive(Debug, Default)]
pub struct Plugs {
    out: Vec<FaultId>,
    /// Place of the one that is plugged in alone.
    alone: Option<usize>,
}

impl Plugs {
    /// Leaves all plugged in, or only the first.
    pub fn new(bus: &mut Bus, only_first: bool) -> Self {
        let mut plugs = Self::default();
        if only_first {
            plugs.leave(bus, 0);
        }
        plugs
    }

    /// Plugs in the next servo alone, and says so.
    pub fn next(&mut self, bus: &mut Bus) -> String {
        let place = self.alone.map_or(0, |place| (place + 1) % SERVOS);
        self.leave(bus, place);
        format!("servo {} alone is plugged in", place + 1)
    }

    /// Plugs in all servos, and says so.
    pub fn all(&mut self, bus: &mut Bus) -> String {
        self.out.drain(..).for_each(|out| bus.end(out));
        self.alone = None;
        "all servos are plugged in".to_owned()
    }

    /// Drops from the faults in force those that only stand for plugs.
    pub fn hide(&self, mut faults: Vec<(FaultId, Fault)>) -> Vec<(FaultId, Fault)> {
        faults.retain(|(id, _)| !self.out.contains(id));
        faults
    }

    fn leave(&mut self, bus: &mut Bus, place: usize) {
        self.all(bus);
        let others = (0..SERVOS).filter(|other| *other != place);
        self.out = others
            .map(|servo| bus.start(Fault::Gone { servo }))
            .collect();
        self.alone = Some(place);
    }
}

#[cfg(test)]
mod tests {
    use robot_servo_model::{Version, so101_servos};

    use super::*;

    fn plugged_in(bus: &mut Bus) -> Vec<usize> {
        bus.advance(bus.now_ns() + 1);
        let views = bus.view().into_iter().zip(1..);
        let with_power = views.filter(|(view, _)| view.supply_v > 0.0);
        with_power.map(|(_, number)| number).collect()
    }

    #[test]
    fn new_servos_are_plugged_in_one_after_the_other_and_then_all() {
        let mut bus = Bus::new(so101_servos(Version::Volts12), 1);
        let mut plugs = Plugs::new(&mut bus, true);
        assert_eq!(plugged_in(&mut bus), [1]);
        plugs.next(&mut bus);
        assert_eq!(plugged_in(&mut bus), [2]);
        assert!(plugs.hide(bus.faults().collect()).is_empty());
        plugs.all(&mut bus);
        assert_eq!(plugged_in(&mut bus), [1, 2, 3, 4, 5, 6]);
    }
}
