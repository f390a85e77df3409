//! The C board's schematic: which net ends at which pin (hardware.md section 1).
