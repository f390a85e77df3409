//! Opens serial ports, and says what to do about one that cannot be opened.
#![forbid(unsafe_code)]

use std::io::ErrorKind;

use serialport::{SerialPort, SerialPortInfo, SerialPortType};

/// Opens a port with eight data bits, no parity and one stop bit. The error says why it failed and what to do.
pub fn open(name: &str, line_bps: u32) -> Result<Box<dyn SerialPort>, String> {
    serialport::new(name, line_bps).open().map_err(|error| {
        let said = error.to_string();
        let advice = advice(error.kind(), name, &ports());
        format!("{}; {advice}", said.trim_end_matches('.'))
    })
}

fn ports() -> Vec<SerialPortInfo> {
    serialport::available_ports().unwrap_or_default()
}

/// Says what to do about a port that cannot be opened, given the ports of this computer.
fn advice(error: serialport::ErrorKind, name: &str, ports: &[SerialPortInfo]) -> String {
    let known = ports
        .iter()
        .find(|port| port.port_name.eq_ignore_ascii_case(name));
    let is_denied = error == serialport::ErrorKind::Io(ErrorKind::PermissionDenied);
    if is_denied && cfg!(target_os = "linux") {
        permission_advice(name, known)
    } else if is_denied || known.is_some() || is_there(name) {
        in_use_advice(name)
    } else if ports.is_empty() {
        "this computer has no serial port: is the adapter plugged in?".to_owned()
    } else {
        let names: Vec<&str> = ports.iter().map(|port| port.port_name.as_str()).collect();
        format!("serial ports here: {}", names.join(", "))
    }
}

/// True for a device file that no list of ports names, such as a pseudo-terminal.
fn is_there(name: &str) -> bool {
    cfg!(unix) && std::path::Path::new(name).exists()
}

/// Gives the rule that makes udev open this kind of adapter to the user at the computer, and the group for all others.
fn permission_advice(name: &str, port: Option<&SerialPortInfo>) -> String {
    let device = match port.map(|port| &port.port_type) {
        Some(SerialPortType::UsbPort(usb)) => format!(
            "ATTRS{{idVendor}}==\"{:04x}\", ATTRS{{idProduct}}==\"{:04x}\"",
            usb.vid, usb.pid
        ),
        _ => {
            let kernel = name.rsplit('/').next().unwrap_or(name);
            format!("KERNEL==\"{kernel}\"")
        }
    };
    format!(
        "your user may not open it. For this adapter, put this line into /etc/udev/rules.d/60-jiling.rules, run `sudo \
         udevadm control --reload` and plug it in again:\n    SUBSYSTEM==\"tty\", {device}, MODE=\"0660\", \
         TAG+=\"uaccess\"\n  Or for all serial ports: `sudo usermod -aG dialout $USER` (on Arch the group is uucp), and \
         log in again"
    )
}

fn in_use_advice(name: &str) -> String {
    if cfg!(target_os = "linux") {
        format!(
            "another program may have it open: `fuser -v {name}` names it (ModemManager looks at a new port for some \
             seconds)"
        )
    } else {
        "another program may have it open".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use serialport::{ErrorKind::NoDevice, UsbPortInfo};

    use super::*;

    fn port(name: &str) -> SerialPortInfo {
        SerialPortInfo {
            port_name: name.to_owned(),
            port_type: SerialPortType::Unknown,
        }
    }

    /// Windows reports a port that is in use as missing.
    #[test]
    fn advice_on_a_closed_port_names_the_cause_or_another_port() {
        let ports = ["COM3", "COM12"].map(port);
        let said = advice(NoDevice, "com3", &ports);
        assert!(said.contains("another program"), "{said}");
        let said = advice(NoDevice, "COM4", &ports);
        assert!(said.contains("COM3, COM12"), "{said}");
        assert!(advice(NoDevice, "COM4", &[]).contains("plugged in"));
    }

    #[test]
    fn without_permission_the_rule_for_this_adapter_is_named() {
        let adapter = SerialPortInfo {
            port_name: "/dev/ttyUSB0".to_owned(),
            port_type: SerialPortType::UsbPort(UsbPortInfo {
                vid: 0x1A86,
                pid: 0x7523,
                serial_number: None,
                manufacturer: None,
                product: None,
            }),
        };
        let said = permission_advice("/dev/ttyUSB0", Some(&adapter));
        assert!(
            said.contains("ATTRS{idVendor}==\"1a86\", ATTRS{idProduct}==\"7523\""),
            "{said}"
        );
        assert!(said.contains("dialout"), "{said}");
        let said = permission_advice("/dev/ttyS4", None);
        assert!(said.contains("KERNEL==\"ttyS4\""), "{said}");
    }
}
