//! Gains of the balance controller against SciPy.

mod image;
mod scipy;
