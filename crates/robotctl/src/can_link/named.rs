//! A link whose failures name the device.

use std::time::Instant;

use robot_app::domain::CanFrame;

use super::{CanLink, CanLinkError};

pub(super) struct Named {
    pub device: String,
    pub link: Box<dyn CanLink>,
}

/// Puts the device into an error of its input and output.
pub(super) fn named(device: &str, error: CanLinkError) -> CanLinkError {
    match error {
        CanLinkError::Failed(source) => CanLinkError::PortFailed {
            device: device.to_string(),
            source,
        },
        other => other,
    }
}

impl CanLink for Named {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError> {
        let sent = self.link.send(frame);
        sent.map_err(|error| named(&self.device, error))
    }

    fn receive(&mut self, deadline: Instant) -> Result<Option<CanFrame>, CanLinkError> {
        let received = self.link.receive(deadline);
        received.map_err(|error| named(&self.device, error))
    }

    fn why_silent(&self) -> String {
        self.link.why_silent()
    }
}
