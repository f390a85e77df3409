//! Numbers of a record by their names.

use std::collections::HashMap;

use robot_sim::machine::{Machine, StaticRecord};

/// A record of the image.
pub struct Numbers {
    record: StaticRecord,
    places: HashMap<String, usize>,
    values: Vec<f64>,
}

impl Numbers {
    /// A record of a type in the static whose name ends so.
    pub fn of(statik: &str, record: &str) -> Self {
        let record =
            StaticRecord::find(&robot_test_support::image(), statik, record).expect("a record");
        let places = record.names().map(str::to_owned).zip(0..).collect();
        Self {
            record,
            places,
            values: Vec::new(),
        }
    }

    /// Reads the record as it stands in memory; `index` counts those of an array.
    pub fn read(&mut self, machine: &Machine, index: u32) {
        self.values = machine.read(&self.record, index);
    }

    pub fn get(&self, name: &str) -> f64 {
        self.values[*self.places.get(name).unwrap_or_else(|| panic!("no {name}"))]
    }

    pub fn f32(&self, name: &str) -> f32 {
        self.get(name) as f32
    }

    pub fn f32s<const N: usize>(&self, name: &str) -> [f32; N] {
        std::array::from_fn(|n| self.f32(&format!("{name}.{n}")))
    }

    pub fn u8(&self, name: &str) -> u8 {
        self.get(name) as u8
    }

    pub fn u16(&self, name: &str) -> u16 {
        self.get(name) as u16
    }

    pub fn u32(&self, name: &str) -> u32 {
        self.get(name) as u32
    }

    pub fn u64(&self, name: &str) -> u64 {
        self.get(name) as u64
    }

    pub fn flag(&self, name: &str) -> bool {
        self.get(name) != 0.0
    }
}
