use crate::soc::peripheral::{Ctx, Peripheral, Unmodelled};
pub struct Absent(pub &'static str);
impl Absent {
    fn no(&self, offset: u32, what: &str) -> Unmodelled {
        Unmodelled { register: format!("{}+{offset:#x}", self.0), what: what.to_owned() }
    }
}
impl Peripheral for Absent {
    fn read(&mut self, offset: u32, _size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        Err(self.no(offset, "read"))
    }
    fn write(&mut self, offset: u32, _size: u8, _value: u32, _ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        Err(self.no(offset, "write"))
    }
    fn event(&mut self, _tag: u32, _ctx: &mut Ctx<'_>) {}
    fn reset(&mut self, _ctx: &mut Ctx<'_>) {}
}
