//! Both receivers of the PC link on streams that no line should carry, judged from the rules of docs/pc-link.md, which
//! are written here once more without the receivers' code.

mod any_bytes;
mod damage;
mod silence;
mod specification;
mod streams;
