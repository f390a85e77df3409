//! The frames that stop every motor, for those moments when nothing else of this code can be trusted.

use super::m3508;
use crate::domain::{BusId, CanFrame};

/// Zero current for speed controllers 1 to 4 on both buses. Constant: boot, panic and fault handlers send it as it is.
pub const fn safe_frames() -> [(BusId, CanFrame); 2] {
    let zero = CanFrame::new(m3508::COMMAND_ID, [0; 8]);
    [(BusId::Can1, zero), (BusId::Can2, zero)]
}
