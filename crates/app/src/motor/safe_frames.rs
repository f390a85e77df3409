//! The frames that stop every motor, for those moments when nothing else of this code can be trusted.

use super::layout::ROBOT_LAYOUT;
use crate::domain::{BusId, CanFrame};

/// Constant: boot, panic and fault handlers send them as they are. Right for both layouts, whose joints have the same
/// numbers and the same disable frame.
pub const fn safe_frames() -> [(BusId, CanFrame); 5] {
    ROBOT_LAYOUT.safe_frames()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motor::layout::RS00_LAYOUT;

    #[test]
    fn both_layouts_stop_alike() {
        assert_eq!(RS00_LAYOUT.safe_frames(), safe_frames());
    }
}
