//! Gains of the balance controller against SciPy and against the free plant.

mod scipy;
