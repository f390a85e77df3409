//! The parameter store on the chip's flash cells: power cuts at every step, damage, defects, wear.
//!
//! The expected contents come from a ledger, outside of the store, of the saves that it has confirmed.

mod bench;
mod damage;
mod defects;
mod first_cut;
mod foreign;
mod many_cuts;
mod second_cut;
mod wear;
mod workload;
