use super::*;

fn accesses(code: &[u16]) -> WordAccesses {
    let bytes: Vec<u8> = code.iter().flat_map(|half| half.to_le_bytes()).collect();
    word_accesses(&bytes)
}

fn before(register: u32, plus: u32) -> WordAccesses {
    WordAccesses {
        before: 1 << (4 * register + plus),
        ..WordAccesses::default()
    }
}

const WRONG: WordAccesses = WordAccesses {
    before: 0,
    after: 0,
    wrong: true,
};
/// ldrd r0, r1, [r2]
const LDRD: [u16; 2] = [0xE9D2, 0x0100];

#[test]
fn the_base_register_is_checked_before_the_block() {
    for code in [
        &LDRD[..],
        &[0xE9C2, 0x0102],         // strd r0, r1, [r2, #8]
        &[0xCA03],                 // ldm r2!, {r0, r1}
        &[0xC203],                 // stm r2!, {r0, r1}
        &[0xE892, 0x0003],         // ldm.w r2, {r0, r1}
        &[0xED92, 0x0A01],         // vldr s0, [r2, #4]
        &[0xED82, 0x0B00],         // vstr d0, [r2]
        &[0xECB2, 0x0A04],         // vldm r2!, {s0-s3}
        &[0x6010, 0xE9D2, 0x0100], // str r0, [r2]; ldrd r0, r1, [r2]
    ] {
        assert_eq!(accesses(code), before(2, 0), "{code:04X?}");
    }
}

#[test]
fn an_addition_before_the_access_counts() {
    for (code, plus) in [
        (&[0x3201][..], 1),     // adds r2, #1
        (&[0x1E92], 2),         // subs r2, r2, #2
        (&[0xF102, 0x0207], 3), // add.w r2, r2, #7
        (&[0xF6A2, 0x72FF], 1), // subw r2, r2, #0xFFF
        (&[0x4613, 0x461A], 0), // mov r3, r2; mov r2, r3
        (&[0xF5A2, 0x6280], 0), // sub.w r2, r2, #0x400
        (&[0xF2C2, 0x0200], 0), // movt r2, #0x2000
    ] {
        let code = [code, &LDRD].concat();
        assert_eq!(accesses(&code), before(2, plus), "{code:04X?}");
    }
}

#[test]
fn a_constant_address_is_judged_at_once() {
    for (code, wrong) in [
        (&[0xF240, 0x0201, 0xF2C2, 0x0200][..], true), // movw r2, #1; movt r2, #0x2000
        (&[0xF240, 0x0204, 0xF2C2, 0x0200], false),    // movw r2, #4; movt r2, #0x2000
        (&[0x2203], true),                             // movs r2, #3
        (&[0xF042, 0x0201], true),                     // orr r2, r2, #1
        (&[0xF022, 0x0203], false),                    // bic r2, r2, #3
        (&[0xF04F, 0x5200], false),                    // mov.w r2, #0x20000000
        (&[0xAA01], false),                            // add r2, sp, #4
    ] {
        let expected = if wrong {
            WRONG
        } else {
            WordAccesses::default()
        };
        let code = [code, &LDRD].concat();
        assert_eq!(accesses(&code), expected, "{code:04X?}");
    }
}

#[test]
fn a_register_that_cannot_be_followed_is_checked_after_the_block() {
    let after = WordAccesses {
        after: 1 << 2,
        ..WordAccesses::default()
    };
    let loaded = |rest: &[u16]| accesses(&[&[0x681A], rest].concat()); // ldr r2, [r3]
    assert_eq!(loaded(&LDRD), after);
    assert_eq!(loaded(&[0xE9D2, 0x0100, 0x2200]), WordAccesses::default()); // then movs r2, #0
    assert_eq!(loaded(&[0xE9D2, 0x2300]), WordAccesses::default()); // ldrd r2, r3, [r2]
}

#[test]
fn conditional_accesses_and_the_stack_are_left_alone() {
    // it eq; ldrdeq r0, r1, [r2]
    assert_eq!(accesses(&[0xBF08, 0xE9D2, 0x0100]), WordAccesses::default());
    // it eq; moveq r2, #1; ldrd r0, r1, [r2]: either value.
    let either = accesses(&[0xBF08, 0x2201, 0xE9D2, 0x0100]);
    assert_eq!((either.before, either.after), (0, 1 << 2));
    // push {r0, r1}; ldrd r0, r1, [sp]; vldr s0, [sp, #4]; pop {r0, r1}
    let stack = [0xB403, 0xE9DD, 0x0100, 0xED9D, 0x0A01, 0xBC03];
    assert_eq!(accesses(&stack), WordAccesses::default());
}
