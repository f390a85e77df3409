//! What a servo does, from the manufacturer's memory table and from what users measured.

mod arm;
mod bus;
mod host;
mod motion;
mod protection;
mod registers;
