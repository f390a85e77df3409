//! Gains of the balance controller against SciPy, the image and the simulated robot.

mod image;
mod plant;
mod scipy;
