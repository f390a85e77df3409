#![no_std]
#![no_main]

compile_error!(
    "the tests run on this machine, not on the board: \
     `cargo xtask test` runs all of them, `cd host-tests && cargo test` those of the control loop"
);

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
