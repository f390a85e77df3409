//! A recording of the sensors over the channel.

use super::*;

/// 600 s = 0x0258. State 1 without samples.
#[test]
fn a_recording_can_be_started_observed_and_ended() {
    let mut bench = Bench::default();
    assert_eq!(bench.read(&[0x43]), [0x43, 0, 0, 0, 0, 0, 0, 0]);
    let start = [0x42, 0x58, 0x02, 0, 0, 0, 0, 0];
    assert_eq!(
        bench.reply(TuningGate::Shut, 0x7A0, &start),
        [0xEE, 0x42, 5, 0, 0, 0, 0, 0]
    );
    assert_eq!(
        bench.write(&[0x42, 0x59, 0x02, 0, 0, 0, 0, 0]),
        [0xEE, 0x42, 4, 0, 0, 0, 0, 0]
    );
    assert!(!bench.channel.recorder().is_running());
    assert_eq!(bench.write(&start), start);
    bench.diagnostics.sensors.mag.ts_us = 1;
    let recorded = bench
        .channel
        .recorder()
        .next(TuningGate::Open, &bench.diagnostics.sensors);
    assert!(recorded.is_some_and(|(port, _)| port == TuningPort::Bus(BusId::Can1)));
    assert_eq!(bench.read(&[0x43]), [0x43, 1, 0, 0, 0, 1, 0, 0]);
    bench.write(&[0x42, 0, 0, 0, 0, 0, 0, 0]);
    assert!(!bench.channel.recorder().is_running());
    assert!(bench.unchanged());
}
