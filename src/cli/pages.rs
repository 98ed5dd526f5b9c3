//! The pages about diagnostic codes, embedded in the binary: every file of `docs/errors/` (a test
//! compares).

/// Pairs codes with the texts of their pages.
macro_rules! embed {
    ($($code:literal),* $(,)?) => {
        &[$(($code, include_str!(concat!("../../docs/errors/", $code, ".md")))),*]
    };
}

/// The code and page of each code, by code.
const PAGES: &[(&str, &str)] = embed![
    "E0001", "E0002", "E0003", "E0004", "E0005", "E0006", "E0007", "E0008", "E0009", "E0010", "E0101",
    "E0102", "E0103", "E0104", "E0105", "E0106", "E0107", "E0108", "E0201", "E0202", "E0203", "E0204",
    "E0205", "E0206", "E0207", "E0208", "E0209", "E0210", "E0211", "E0301", "E0302", "E0303", "E0304",
    "E0305", "E0306", "E0307", "E0308", "E0309", "E0310", "E0311", "E0312", "E0313", "E0314", "E0315",
    "E0316", "E0317", "E0318", "E0319", "E0320", "E0401", "E0402", "E0403", "E0404", "E0405", "E0406",
    "E0407", "E0408", "E0409", "E0410", "E0411", "E0501", "E0502", "E0503", "E0504", "E0505", "E0506",
    "E0507", "E0508", "E0509", "E0510", "E0511", "E0601", "E0602", "E0603", "E0604", "E0605", "E0606",
    "E0607", "E0608", "E0609", "E0610", "E0611", "E0612", "E0613", "E0614", "E0615", "E0701", "E0702",
    "E0703", "E0704", "E0705", "E0706", "E0707", "E0801", "E0802", "E0803", "E0804", "E0805", "E0806",
    "E0807", "W0001", "W0002", "W0003", "W0004", "W0005", "W0006", "W0007", "W0008", "W0009", "W0010",
    "N0001",
];

/// Returns the page of explanation of a diagnostic code, such as `E0301`; `None` if there is no such code.
pub(super) fn page(code: &str) -> Option<&'static str> {
    PAGES.iter().find(|(known, _)| *known == code).map(|(_, page)| *page)
}
