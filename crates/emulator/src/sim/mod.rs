//! Scenarios on the machine: what is asked of it, what is recorded, what is written down.
