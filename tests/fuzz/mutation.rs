//! Input number n: some texts of a corpus, cut, doubled, crossed and spoilt.

use rodcal::statistics::Random;

/// What readers stumble over.
const TOKENS: [&str; 40] = [
    "0",
    "-0",
    "-1",
    "1e30",
    "1e308",
    "1e309",
    "5e-324",
    "1e-310",
    "1e-291",
    "NaN",
    "inf",
    "-inf",
    "1000000000000000000",
    "99999999999999999999999999",
    "0x7fffffffffffffff",
    "1,5",
    "\"",
    "'",
    "\"\"\"",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "=",
    ",",
    ";",
    "\t",
    "\n",
    "\r\n",
    "#",
    "<",
    "/>",
    "&#0;",
    "\0",
    "\u{1b}[31m",
    "\u{202e}",
    "\u{feff}",
    "µ",
];

pub fn mutated(corpus: &[&str], n: u64) -> Vec<u8> {
    let mut random = Random::seeded(20_261_122, n);
    let mut bytes = corpus[random.index(corpus.len())].as_bytes().to_vec();
    for _ in 0..random.index(6) {
        mutate(&mut bytes, corpus, &mut random);
    }
    bytes
}

fn mutate(bytes: &mut Vec<u8>, corpus: &[&str], random: &mut Random) {
    let length = bytes.len();
    let (a, b) = (random.index(length + 1), random.index(length + 1));
    let (from, to) = (a.min(b), a.max(b));
    let short = from..(from + random.index(20)).min(length);
    match random.index(10) {
        0 if length > 0 => bytes[a.min(length - 1)] ^= 1 << random.index(8),
        1 => drop(bytes.drain(short)),
        2 => drop(bytes.drain(from..to)),
        3 => bytes.truncate(a),
        4 => {
            let copy = bytes[short].to_vec();
            let many = random.index(50);
            bytes.splice(b..b, std::iter::repeat_n(copy, many).flatten());
        }
        5 => {
            let other = corpus[random.index(corpus.len())].as_bytes();
            let cut = random.index(other.len());
            bytes.splice(from..to, other[cut..].iter().copied());
        }
        6 => {
            let token = TOKENS[random.index(TOKENS.len())];
            let many = if random.index(8) == 0 { 300 } else { 1 };
            bytes.splice(a..a, token.repeat(many).into_bytes());
        }
        // a number becomes another
        _ => {
            let is_digit = |byte: &u8| byte.is_ascii_digit();
            let Some(start) = bytes[a..].iter().position(is_digit).map(|at| a + at) else { return };
            let is_number = |byte: &u8| byte.is_ascii_digit() || b".eE-".contains(byte);
            let end = bytes[start..].iter().position(|byte| !is_number(byte)).map_or(length, |at| start + at);
            let token = TOKENS[random.index(TOKENS.len())];
            bytes.splice(start..end, token.bytes());
        }
    }
}
