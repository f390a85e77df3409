//! What surrounds the robot.

use super::{FLOOR, named, touching};
use crate::xml::Element;

/// Size of pictures, and the camera of a viewer.
pub(super) fn visual() -> Element {
    Element::new("visual")
        .child(
            Element::new("global")
                .numbers("azimuth", &[130.0])
                .numbers("elevation", &[-15.0])
                .numbers("offwidth", &[1280.0])
                .numbers("offheight", &[960.0]),
        )
        .child(Element::new("headlight").numbers("ambient", &[0.3, 0.3, 0.3]))
}

pub(super) fn assets() -> Element {
    let checker = named("texture", "checker")
        .text("type", "2d")
        .text("builtin", "checker")
        .numbers("rgb1", &[0.75, 0.77, 0.8])
        .numbers("rgb2", &[0.65, 0.67, 0.7])
        .numbers("width", &[256.0])
        .numbers("height", &[256.0]);
    let floor = named("material", "floor")
        .text("texture", "checker")
        .numbers("texrepeat", &[2.0, 2.0])
        .text("texuniform", "true");
    Element::new("asset").child(checker).child(floor)
}

pub(super) fn surroundings() -> [Element; 2] {
    let light = Element::new("light")
        .numbers("pos", &[0.0, 0.0, 4.0])
        .numbers("dir", &[0.2, 0.3, -1.0])
        .text("type", "directional");
    let floor = touching(named("geom", "floor"), FLOOR)
        .text("type", "plane")
        .numbers("size", &[0.0, 0.0, 0.5])
        .text("material", "floor");
    [light, floor]
}
