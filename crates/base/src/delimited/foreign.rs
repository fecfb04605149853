//! Headers in other languages, and in other spellings: what their columns are called here.

use super::quoted;

/// Words for what a column holds, without accents (ä is ae, é is e), and its name here. `#` stands
/// for the joint's number, `@` for an axis. German, French, Italian and Spanish, for laboratories
/// export in the language of their spreadsheet.
/// As controllers write them too: A1 … A6, J1, X.
const WORDS: [(&str, &str); 17] = [
    ("a j", "q#_deg"),
    ("x y z", "@_mm"),
    ("achse gelenk gelenkwinkel winkel joint axe articulation asse giunto eje", "q#_deg"),
    ("achse richtung lastrichtung axe direction asse direzione eje direccion", "axis"),
    ("kraft last belastung force charge forza carico fuerza carga", "load_n"),
    ("masse gewicht massa peso masa", "load_kg"),
    ("verschiebung weg auslenkung durchbiegung deplacement fleche", "d@_um"),
    ("spostamento freccia desplazamiento flecha", "d@_um"),
    ("position koordinate posizione posicion coordonnee coordenada", "@_mm"),
    ("versuch messreihe durchgang essai prova ensayo", "trial"),
    ("fase", "phase"),
    ("zeit temps tempo tiempo", "time_s"),
    ("temperatur temperatura", "temperature_c"),
    ("pose stellung messpunkt posa postura", "pose"),
    ("klemme spannstelle pince morsetto mordaza", "clamp"),
    ("aufstellung emplacement collocazione emplazamiento", "placement"),
    ("kugelpfanne pfanne alveole alojamiento", "socket"),
];

/// What the columns of a header would be called here, as a hint; `None` where none of the `missing`
/// names is among them. `known` are the names that the file may have; those that the header has
/// already are not said again.
pub fn renamed<'t>(
    columns: impl Iterator<Item = &'t str>,
    known: &[&str],
    missing: &[&str],
) -> Option<String> {
    let columns: Vec<&str> = columns.collect();
    let mut said: Vec<String> = Vec::new();
    let mut taken: Vec<&str> = Vec::new();
    for column in &columns {
        let Some((name, unit)) = translated(column, known) else { continue };
        let is_there = columns.iter().any(|other| other.eq_ignore_ascii_case(name));
        if is_there || taken.contains(&name) {
            continue;
        }
        taken.push(name);
        let own = name.rsplit_once('_').map_or("", |(_, own)| own);
        let as_written = |unit: String| {
            let mut words = column.split(|c: char| !c.is_alphanumeric());
            words.find(|word| word.to_lowercase() == unit).map_or(unit.clone(), str::to_owned)
        };
        let other = unit.filter(|unit| unit != own && !own.is_empty()).map(as_written);
        let convert = other.map_or(String::new(), |unit| format!(" (converted from {unit})"));
        said.push(format!("{} to {name}{convert}", quoted(column)));
    }
    let helps = taken.iter().any(|name| missing.contains(name));
    helps.then(|| format!("rename {}", said.join(", ")))
}

/// The known name that a column of another language stands for, and the unit that it states.
fn translated<'k>(column: &str, known: &[&'k str]) -> Option<(&'k str, Option<String>)> {
    let pieces = pieces(column);
    let (word, rest) = pieces.split_first()?;
    let number = rest.iter().find(|piece| piece.chars().all(|c| c.is_ascii_digit()));
    let axis = pieces.iter().find(|piece| ["x", "y", "z"].contains(&piece.as_str()));
    let unit = rest.iter().rfind(|piece| Some(*piece) != number && Some(*piece) != axis);
    let find = |pattern: &str| {
        let name = match (pattern.contains('#'), number, pattern.contains('@'), axis) {
            (true, Some(number), false, _) => pattern.replace('#', number),
            (false, _, true, Some(axis)) => pattern.replace('@', axis),
            (false, None, false, _) => pattern.to_owned(),
            _ => return None,
        };
        known.iter().copied().find(|known| **known == name)
    };
    // "Last [kg]" and "Masse [N]" are what their unit says
    let by_unit = |name: &'k str| match (name, unit.map(String::as_str)) {
        ("load_n", Some("kg")) => find("load_kg"),
        ("load_kg", Some("n")) => find("load_n"),
        _ => Some(name),
    };
    // `x_m` is no other language: another unit
    if axis == Some(word) && column.contains('_') {
        return None;
    }
    let mut meant = WORDS.iter().filter(|(words, _)| words.split(' ').any(|known| known == word));
    let name = meant.find_map(|(_, pattern)| find(pattern)).and_then(by_unit)?;
    Some((name, unit.cloned()))
}

/// Words, numbers and units of a name, in lower case and without accents: `Verschiebung_Y [µm]` is
/// `verschiebung`, `y`, `um`.
fn pieces(column: &str) -> Vec<String> {
    let mut pieces: Vec<String> = vec![String::new()];
    let mut digits = false;
    for letter in column.to_lowercase().chars() {
        if !(letter.is_alphanumeric() || letter == '°') {
            pieces.push(String::new());
            continue;
        }
        if letter.is_ascii_digit() != digits {
            digits = !digits;
            pieces.push(String::new());
        }
        let plain = match letter {
            'ä' => "ae",
            'ö' => "oe",
            'ü' => "ue",
            'ß' => "ss",
            'à' | 'á' | 'â' => "a",
            'è' | 'é' | 'ê' => "e",
            'ì' | 'í' | 'î' => "i",
            'ò' | 'ó' | 'ô' => "o",
            'ù' | 'ú' | 'û' => "u",
            'ç' => "c",
            'ñ' => "n",
            'µ' | 'μ' => "u",
            '°' => "deg",
            other => {
                pieces.last_mut().into_iter().for_each(|piece| piece.push(other));
                continue;
            }
        };
        pieces.last_mut().into_iter().for_each(|piece| piece.push_str(plain));
    }
    // "°C" is one unit
    pieces.retain(|piece| !piece.is_empty());
    pieces.into_iter().map(|piece| if piece == "degc" { "c".into() } else { piece }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIG: [&str; 8] =
        ["axis", "load_n", "load_kg", "dx_um", "dy_um", "trial", "time_s", "temperature_c"];
    const ARM: [&str; 6] = ["pose", "q1_deg", "q2_deg", "x_mm", "y_mm", "time_s"];

    #[test]
    fn columns_of_other_languages_are_mapped_with_their_units() {
        let hint = |columns: &[&str], known: &[&str]| renamed(columns.iter().copied(), known, known);
        let german = ["Achse", "Kraft [kN]", "Versuch", "Verschiebung Y [µm]", "Temperatur [°C]", "Zeit_s"];
        assert_eq!(
            hint(&german, &RIG).unwrap(),
            "rename \"Achse\" to axis, \"Kraft [kN]\" to load_n (converted from kN), \"Versuch\" to trial, \
             \"Verschiebung Y [µm]\" to dy_um, \"Temperatur [°C]\" to temperature_c, \"Zeit_s\" to time_s"
        );
        assert_eq!(
            hint(&["Name", "A1", "J2 [rad]", "X", "Y [m]"], &ARM).unwrap(),
            "rename \"A1\" to q1_deg, \"J2 [rad]\" to q2_deg (converted from rad), \"X\" to x_mm, \
             \"Y [m]\" to y_mm (converted from m)"
        );
        // on a rig nobody knows what X is
        assert_eq!(hint(&["X", "A"], &RIG), None);
        assert_eq!(hint(&["Last (kg)"], &RIG).unwrap(), "rename \"Last (kg)\" to load_kg");
        assert_eq!(
            hint(&["Déplacement x (mm)"], &RIG).unwrap(),
            "rename \"Déplacement x (mm)\" to dx_um (converted from mm)"
        );
        assert_eq!(
            hint(&["Messpunkt", "Achse 1 [°]", "Gelenk2_rad", "Achse3", "Position X"], &ARM).unwrap(),
            "rename \"Messpunkt\" to pose, \"Achse 1 [°]\" to q1_deg, \"Gelenk2_rad\" to q2_deg (converted from rad), \
             \"Position X\" to x_mm"
        );
    }

    #[test]
    fn what_is_there_or_not_known_is_not_mapped() {
        assert_eq!(renamed(["axis", "Achse", "weight", "", "dy_um"].into_iter(), &RIG, &RIG), None);
        assert_eq!(renamed(["Verschiebung", "Achse"].into_iter(), &ARM, &ARM), None);
        // of no help: the column that is missing is another one
        assert_eq!(renamed(["Zeit", "q1_rad"].into_iter(), &ARM, &["q1_deg"]), None);
    }
}
