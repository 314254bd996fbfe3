//! Finding an action by a few letters of its name.
//!
//! The letters must come in order, but others may lie between: *lrp* finds *Learn rigidity from poses*. Letters at the
//! beginnings of words and letters that follow one another count more.

use super::{Action, Session};

/// What a letter counts, by where it is found. Only their order matters; by trial on all labels.
const AT_WORD: i32 = 12;
const IN_A_ROW: i32 = 13;
const ELSEWHERE: i32 = 1;
/// What a letter in the tooltip counts, where whole words are looked for: less than the worst hit in a label.
const IN_TOOLTIP: i32 = -1000;
/// What an action that can do nothing now is put back by: behind one as well named, before others.
const BLOCKED: i32 = 30;

/// Actions that `query` may mean, the likeliest first; without a query the recent ones, then all in the order of menus.
pub fn find_actions(query: &str, session: &Session) -> Vec<Action> {
    let recent = session.habits.recent();
    let rest = Action::all().filter(|action| !recent.contains(action));
    let all: Vec<Action> = recent.iter().copied().chain(rest).collect();
    let query = query.trim().to_lowercase();
    if query.is_empty() {
        return all;
    }
    let mut found: Vec<(i32, Action)> =
        all.into_iter().filter_map(|action| Some((score_of(&query, action, session)?, action))).collect();
    // Stable: among equals the recent ones stay first.
    found.sort_by_key(|(score, _)| -score);
    found.into_iter().map(|(_, action)| action).collect()
}

fn score_of(query: &str, action: Action, session: &Session) -> Option<i32> {
    let label = action.label().to_lowercase();
    let whole = action.full_name().to_lowercase();
    let by_name = score(query, &label).into_iter().chain(score(query, &whole).map(|score| score - 5)).max();
    let score = by_name.or_else(|| action.tooltip().to_lowercase().contains(query).then_some(IN_TOOLTIP))?;
    Some(if action.obstacle(session).is_some() { score - BLOCKED } else { score })
}

/// How well the letters of `query` are found in `text`, both lowercase; `None` if they are not, in this order.
///
/// The best of all ways to find them, by dynamic programming over letters of the query (rows) and of the text.
fn score(query: &str, text: &str) -> Option<i32> {
    let letters: Vec<char> = text.chars().collect();
    // Best score with the last letter found exactly here, and with it found here or before.
    let mut here: Vec<Option<i32>> = vec![None; letters.len()];
    let mut by_here: Vec<Option<i32>> = vec![None; letters.len()];
    for (row, wanted) in query.chars().filter(|letter| !letter.is_whitespace()).enumerate() {
        let (before, by_before) = (here.clone(), by_here.clone());
        for k in 0..letters.len() {
            let starts_word = k == 0 || !letters[k - 1].is_alphanumeric();
            let alone = if starts_word { AT_WORD } else { ELSEWHERE };
            let from_anywhere = if row == 0 { Some(0) } else { by_before.get(k.wrapping_sub(1)).copied().flatten() };
            let in_a_row = before.get(k.wrapping_sub(1)).copied().flatten();
            let best = from_anywhere.map(|sum| sum + alone).max(in_a_row.map(|sum| sum + alone.max(IN_A_ROW)));
            here[k] = best.filter(|_| letters[k] == wanted);
            by_here[k] = here[k].max(if k == 0 { None } else { by_here[k - 1] });
        }
    }
    // Of two equally good ones the shorter text is nearer to what was typed.
    by_here.last().copied().flatten().map(|sum| 4 * sum - letters.len() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::Opened;
    use crate::test_scenes::flat_sheet;

    #[test]
    fn letters_are_found_in_their_order_only() {
        assert!(score("lrp", "learn rigidity from poses…").is_some());
        assert!(score("prl", "learn rigidity from poses…").is_none());
        assert!(score("save", "save as…").is_some());
        assert!(score("", "undo").is_none());
        assert!(score("x", "").is_none());
    }

    #[test]
    fn a_word_in_one_piece_counts_more_than_letters_of_two() {
        assert!(score("pose", "keep pose") > score("pose", "move pose earlier"));
    }

    #[test]
    fn the_action_that_is_meant_comes_first() {
        let session = Session::new(|| {}).expect("a solver thread");
        for (query, expected) in [
            ("undo", Action::UNDO),
            ("lrp", Action::LEARN_RIGIDITY),
            ("wire", Action::TOGGLE_WIREFRAME),
            ("save a", Action::SAVE_AS),
            ("gecko", Action::SAMPLE_GECKO),
            ("brush", Action::TOOL_BRUSH),
            ("top", Action::LOOK_TOP),
            ("  RESET ", Action::RESET_POSE),
        ] {
            assert_eq!(find_actions(query, &session).first(), Some(&expected), "{query}");
        }
    }

    #[test]
    fn what_can_be_done_comes_before_what_cannot() {
        let mut session = Session::new(|| {}).expect("a solver thread");
        session.show(Opened::new(flat_sheet(4).model().clone()), None);
        let found = find_actions("pose", &session);
        assert_eq!(found[0].obstacle(&session), None, "{}", found[0].label());
        let undo = find_actions("undo", &session);
        assert_eq!(undo[0], Action::UNDO, "a name that fits comes first all the same");
        assert!(Action::UNDO.obstacle(&session).is_some());
    }

    #[test]
    fn words_of_the_tooltip_find_an_action_and_nonsense_finds_none() {
        let session = Session::new(|| {}).expect("a solver thread");
        assert!(find_actions("vanishing points", &session).contains(&Action::TOGGLE_PROJECTION));
        assert!(find_actions("qqxzzw", &session).is_empty());
    }
}
