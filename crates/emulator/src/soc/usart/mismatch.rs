//! A receiver that is set to another format than the sender.

use crate::{
    soc::{
        peripheral::Ctx,
        usart::receiver::{Framing, Received},
    },
    wire::LineFormat,
};

/// Reports the sender's format if the receiver is set to another one.
pub fn report(number: u8, sent: LineFormat, framing: &Framing, got: &Received, ctx: &mut Ctx<'_>) {
    let set = framing.format();
    let same_word = set.data_bits == sent.data_bits && set.parity == sent.parity;
    let off_by = u64::from(set.baud.abs_diff(sent.baud)) * 100;
    let wrong_rate = off_by > 3 * u64::from(sent.baud);
    let flagged = got.framing_error || got.parity_error || got.noise;
    // With equal settings an error flag is noise on the line, not a wrong setting.
    if !wrong_rate && (same_word || !flagged) {
        return;
    }
    let effect = if flagged {
        "framing, parity or noise errors"
    } else {
        "wrong data"
    };
    let message = format!("USART{number}: sender sends {sent}, receiver is set to {set}: {effect}");
    ctx.errors.report(ctx.now, message);
}
