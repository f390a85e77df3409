use super::*;

fn section(name: &str, range: Range<u64>) -> Section {
    Section {
        name: name.to_owned(),
        range,
    }
}

/// An image as `memory.x` lays it out.
fn good() -> Image {
    Image {
        programmed: vec![0x0800_0000..0x0800_0188, 0x0801_0000..0x0801_8000],
        sections: vec![
            section(".vector_table", 0x0800_0000..0x0800_0188),
            section(".text", 0x0801_0000..0x0801_8000),
            section(".bss", 0x2000_0000..0x2000_4000),
        ],
        symbols: vec![
            "main".to_owned(),
            "core::alloc::layout::Layout::new".to_owned(),
            "__aeabi_memcpy".to_owned(),
        ],
        reset_words: Some([0x1001_0000, 0x0801_0401]),
    }
}

/// Name of the check that must fail, and how to make it fail.
type Fault = (&'static str, fn(&mut Image));

fn failures(image: &Image) -> Vec<&'static str> {
    let failed = |check: Check| check.outcome.is_err().then_some(check.name);
    image.checks().into_iter().filter_map(failed).collect()
}

#[test]
fn a_correct_image_passes() {
    assert_eq!(failures(&good()), Vec::<&str>::new());
}

#[test]
fn each_check_detects_its_fault() {
    let cases: [Fault; 9] = [
        ("flash budget", |image| {
            image.programmed.push(0x0802_0000..0x0805_8001);
        }),
        ("static RAM budget", |image| {
            image
                .sections
                .push(section(".uninit", 0x2000_4000..0x2001_0001));
        }),
        ("vector table in sector 0", |image| {
            image.reset_words = Some([0x2002_0000, 0x0801_0401]);
        }),
        ("vector table in sector 0", |image| {
            image.reset_words = Some([0x1001_0000, 0x0801_0400]);
        }),
        ("code from sector 4", |image| {
            image.sections.retain(|section| section.name != ".text");
            image
                .sections
                .push(section(".text", 0x0801_0200..0x0801_8000));
        }),
        ("parameter sectors left free", |image| {
            image.programmed.push(0x0800_FFF0..0x0800_FFF4);
        }),
        ("no allocator", |image| {
            image
                .symbols
                .push("<alloc::vec::Vec<u8> as Drop>::drop".to_owned());
        }),
        ("no allocator", |image| {
            image.symbols.push("__rust_alloc".to_owned());
        }),
        ("no double precision", |image| {
            image.symbols.push("__aeabi_dmul".to_owned());
        }),
    ];
    for (expected, spoil) in cases {
        let mut image = good();
        spoil(&mut image);
        assert_eq!(failures(&image), [expected]);
    }
}

#[test]
fn a_file_that_is_no_elf_is_refused() {
    assert!(Image::parse(b"\x7fELF but not really").is_err());
}
