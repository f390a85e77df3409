//! CAN frames as the LAWICEL protocol writes them: `tiiildd…`, `Tiiiiiiiildd…`, `riiil`, `Riiiiiiiil`.

use std::fmt::Write;

use robot_plant::wire::CanFrame;

/// Parses a transmit command without its carriage return. `None` if it is not one.
pub fn parse(line: &[u8]) -> Option<CanFrame> {
    let (kind, rest) = line.split_first()?;
    let (extended, remote, digits, highest) = match kind {
        b't' => (false, false, 3, 0x7FF),
        b'T' => (true, false, 8, 0x1FFF_FFFF),
        b'r' => (false, true, 3, 0x7FF),
        b'R' => (true, true, 8, 0x1FFF_FFFF),
        _ => return None,
    };
    let (id, rest) = rest.split_at_checked(digits)?;
    let (dlc, rest) = rest.split_at_checked(1)?;
    let id = number(id).filter(|id| *id <= highest)?;
    let dlc = number(dlc).filter(|dlc| *dlc <= 8)? as u8;
    let bytes = if remote { 0 } else { usize::from(dlc) };
    if rest.len() != 2 * bytes {
        return None;
    }
    let mut data = [0; 8];
    for (byte, digits) in data.iter_mut().zip(rest.chunks_exact(2)) {
        *byte = number(digits)? as u8;
    }
    Some(CanFrame {
        id,
        extended,
        remote,
        dlc,
        data,
    })
}

/// Appends a received frame with its carriage return, and with `stamp_ms` if time stamps are on.
pub fn append(frame: &CanFrame, stamp_ms: Option<u16>, out: &mut String) {
    let kind = match (frame.extended, frame.remote) {
        (false, false) => 't',
        (true, false) => 'T',
        (false, true) => 'r',
        (true, true) => 'R',
    };
    let digits = if frame.extended { 8 } else { 3 };
    let carried = if frame.remote { 0 } else { frame.dlc };
    // Writing to a string cannot fail.
    let _ = write!(out, "{kind}{:0digits$X}{}", frame.id, frame.dlc);
    for byte in frame.data.iter().take(usize::from(carried)) {
        let _ = write!(out, "{byte:02X}");
    }
    if let Some(stamp) = stamp_ms {
        let _ = write!(out, "{stamp:04X}");
    }
    out.push('\r');
}

/// Parses one to eight hexadecimal digits, without sign or blanks.
pub fn number(digits: &[u8]) -> Option<u32> {
    let all_digits = digits.iter().all(u8::is_ascii_hexdigit);
    let text = std::str::from_utf8(digits).ok().filter(|_| all_digits)?;
    u32::from_str_radix(text, 16).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn data(id: u32, extended: bool, bytes: &[u8]) -> CanFrame {
        let mut data = [0; 8];
        data[..bytes.len()].copy_from_slice(bytes);
        CanFrame {
            id,
            extended,
            remote: false,
            dlc: bytes.len() as u8,
            data,
        }
    }

    // Examples of the CANUSB manual: commands t, T, r, R.
    #[test]
    fn the_manuals_examples_are_read() {
        assert_eq!(parse(b"t10021133"), Some(data(0x100, false, &[0x11, 0x33])));
        assert_eq!(
            parse(b"T0000010021133"),
            Some(data(0x100, true, &[0x11, 0x33]))
        );
        let asked = CanFrame {
            remote: true,
            dlc: 2,
            ..data(0x100, false, &[])
        };
        assert_eq!(parse(b"r1002"), Some(asked));
        let asked = CanFrame {
            extended: true,
            ..asked
        };
        assert_eq!(parse(b"R000001002"), Some(asked));
        assert_eq!(parse(b"t7ff0"), Some(data(0x7FF, false, &[])));
    }

    #[test]
    fn lines_that_are_no_frame_are_refused() {
        let wrong: [&[u8]; 11] = [
            b"",
            b"t",
            b"t10",
            b"t100",
            b"t8000",
            b"t1009",
            b"t100211",
            b"t1002113355",
            b"t100+1",
            b"T200000000",
            b"r100211",
        ];
        for line in wrong {
            assert_eq!(parse(line), None, "{}", String::from_utf8_lossy(line));
        }
    }

    #[test]
    fn received_frames_are_written_with_and_without_a_time_stamp() {
        let text = |frame: &CanFrame, stamp| {
            let mut out = String::new();
            append(frame, stamp, &mut out);
            out
        };
        let command = data(0x200, false, &[0x03, 0xE8, 0xFC, 0x18, 0x40, 0, 0xC0, 0]);
        assert_eq!(text(&command, None), "t200803E8FC184000C000\r");
        assert_eq!(
            text(&data(0x1ABCDEF, true, &[0xA5]), Some(0xEA5F)),
            "T01ABCDEF1A5EA5F\r"
        );
        let asked = CanFrame {
            remote: true,
            dlc: 8,
            ..data(0x7A1, false, &[])
        };
        assert_eq!(text(&asked, Some(1)), "r7A180001\r");
    }
}
