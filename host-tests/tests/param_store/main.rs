//! The parameter store on the chip's flash cells: power cuts at every step, damage, defects, wear.
//!
//! What is right comes from a ledger of the saves the store has confirmed, kept outside of it.

mod bench;
mod damage;
mod defects;
mod first_cut;
mod foreign;
mod many_cuts;
mod second_cut;
mod wear;
mod workload;
