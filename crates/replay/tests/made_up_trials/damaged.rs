//! Errors in the files are reported with the file's name.

use std::{fs, path::Path};

use robot_replay::{Trial, load};

use crate::recorder::{self, HZ200, Turn};

const TURN: Turn = Turn {
    rate_dps: 10.0,
    reference_off_deg: 0.0,
};

fn error(folder: &Path) -> String {
    load(folder).err().expect("it is damaged").to_string()
}

#[test]
fn a_missing_empty_or_ambiguous_folder_is_reported() {
    let folder = recorder::folder("folders");
    assert!(error(&folder.join("nowhere")).contains("nowhere"));
    assert!(error(&folder).contains("NAME.json"));
    for below in ["hz200", "native"] {
        fs::create_dir(folder.join(below)).unwrap();
        recorder::write(&folder.join(below), "turn", HZ200, &TURN.columns(HZ200));
        assert_eq!(load(&folder.join(below)).unwrap().len(), 1);
    }
    let both = error(&folder);
    assert!(both.contains("hz200") && both.contains("native"), "{both}");
    fs::remove_dir_all(folder.join("native")).unwrap();
    assert_eq!(load(&folder).unwrap()[0].name, "turn");
}

#[test]
fn missing_data_and_a_wrong_length_are_reported() {
    let folder = recorder::folder("length");
    let header = recorder::write(&folder, "turn", HZ200, &TURN.columns(HZ200));
    let text = fs::read_to_string(&header).unwrap();
    fs::write(&header, text.replace("8000", "8001")).unwrap();
    let length = error(&folder);
    assert!(
        length.contains("turn") && length.contains("480060 bytes"),
        "{length}"
    );
    fs::remove_file(folder.join("turn.f32.gz")).unwrap();
    assert!(error(&folder).contains("turn.f32.gz"));
}

/// `e3b0…b855` is the SHA-256 of an empty input (FIPS 180-4 examples).
#[test]
fn a_wrong_checksum_is_reported() {
    let folder = recorder::folder("checksum");
    let header = recorder::write(&folder, "turn", HZ200, &TURN.columns(HZ200));
    assert!(Trial::read(&header).is_ok());
    let nothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
    let text = fs::read_to_string(&header).unwrap();
    let with_sum = text.replacen('{', &format!("{{\"sha256_raw\":\"{nothing}\","), 1);
    fs::write(&header, with_sum).unwrap();
    assert!(error(&folder).contains(nothing));
}
