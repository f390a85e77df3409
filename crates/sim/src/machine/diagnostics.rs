//! The firmware's diagnostics record. It is read from guest memory by the layout in the image's debug information.

use robot_emulator::core::{cpu::Cpu, image::Image};

mod layout;
pub mod meaning;

pub use layout::LayoutError;
use layout::Leaf;
pub(super) use layout::{Record, of_static as record_of_static};
use meaning::Meaning;

/// The static that holds the record, and the record's type.
const STATIC: &str = "g_robotapp_diag";
const RECORD: &str = "DiagnosticsSnapshot";
/// The field with the arming state, and its value while armed.
const ARMING_STATE: &str = "arming.state";
const ARMED: f64 = 1.0;

/// Names, layout and the last complete copy of the record. Empty for an image without such a record.
#[derive(Debug, Default)]
pub struct Diagnostics {
    address: u32,
    leaves: Vec<Leaf>,
    /// Place of `ARMING_STATE`.
    arming: Option<usize>,
    names: Vec<String>,
    copy: Vec<u8>,
    copied: bool,
}

impl Diagnostics {
    pub fn find(elf: &[u8], image: &Image) -> Result<Self, LayoutError> {
        let Some(base) = image.symbol(STATIC) else {
            return Ok(Self::default());
        };
        let record = layout::of_static(elf, STATIC, RECORD)?;
        Ok(Self {
            address: base + record.offset,
            names: record
                .leaves
                .iter()
                .map(|leaf| format!("diag.{}", leaf.name))
                .collect(),
            copy: vec![0; record.size as usize],
            arming: record.leaves.iter().position(|l| l.name == ARMING_STATE),
            leaves: record.leaves,
            copied: false,
        })
    }

    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Meanings of the values, in the order of `names`.
    pub fn meanings(&self) -> Vec<Option<Meaning>> {
        self.leaves
            .iter()
            .map(|leaf| leaf.meaning.clone())
            .collect()
    }

    /// Copies the record. It must be called only where the record cannot be half-written.
    pub fn copy_from(&mut self, cpu: &Cpu) {
        self.copied = !self.copy.is_empty() && cpu.read_memory(self.address, &mut self.copy);
    }

    /// Whether the last copy shows an armed robot; false for an image without an arming state.
    pub fn armed(&self) -> bool {
        let arming = self.arming.and_then(|place| self.leaves.get(place));
        self.copied && arming.is_some_and(|leaf| leaf.read(&self.copy) == ARMED)
    }

    /// Discards the copy: after a reset the record is that of the boot before.
    pub fn forget(&mut self) {
        self.copied = false;
    }

    pub fn sample(&self, out: &mut Vec<f64>) -> bool {
        out.clear();
        if self.copied {
            out.extend(self.leaves.iter().map(|leaf| leaf.read(&self.copy)));
        }
        self.copied
    }
}
