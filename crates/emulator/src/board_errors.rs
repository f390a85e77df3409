//! What real silicon would punish silently, said aloud: each entry names the wrong setting and what it breaks.

use robot_plant::time::Ps;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoardError {
    /// When it was first seen.
    pub at: Ps,
    pub count: u64,
    pub message: String,
}

/// Distinct messages in the order they were first seen.
#[derive(Debug, Default)]
pub struct BoardErrors {
    list: Vec<BoardError>,
}

impl BoardErrors {
    pub fn report(&mut self, at: Ps, message: impl Into<String>) {
        let message = message.into();
        match self.list.iter_mut().find(|e| e.message == message) {
            Some(e) => e.count += 1,
            None => self.list.push(BoardError {
                at,
                count: 1,
                message,
            }),
        }
    }

    pub fn list(&self) -> &[BoardError] {
        &self.list
    }
}
