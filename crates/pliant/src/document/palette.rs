//! Colors of groups: eight that people with any common color blindness can tell apart.

use super::GroupKind;

/// One of eight colors, after the set of Okabe and Ito (2008). Its yellow is the paper's for handles, its black the dark
/// of anchors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GroupColor {
    /// What handles begin with.
    Yellow,
    /// What anchors begin with.
    Dark,
    /// Between yellow and red.
    Orange,
    /// Light blue.
    Sky,
    /// Bluish green.
    Green,
    /// Full blue.
    Blue,
    /// Red with some orange.
    Vermilion,
    /// Reddish purple.
    Purple,
}

impl GroupColor {
    /// In the order in which they are offered.
    pub const ALL: [GroupColor; 8] = [
        GroupColor::Yellow,
        GroupColor::Orange,
        GroupColor::Vermilion,
        GroupColor::Purple,
        GroupColor::Blue,
        GroupColor::Sky,
        GroupColor::Green,
        GroupColor::Dark,
    ];

    /// What a new group of this kind has.
    pub fn of_kind(kind: GroupKind) -> GroupColor {
        match kind {
            GroupKind::Handle => GroupColor::Yellow,
            GroupKind::Anchor => GroupColor::Dark,
        }
    }

    /// Its name, for people and for files.
    pub fn name(self) -> &'static str {
        match self {
            GroupColor::Yellow => "yellow",
            GroupColor::Dark => "dark",
            GroupColor::Orange => "orange",
            GroupColor::Sky => "sky",
            GroupColor::Green => "green",
            GroupColor::Blue => "blue",
            GroupColor::Vermilion => "vermilion",
            GroupColor::Purple => "purple",
        }
    }

    /// The color of that name.
    pub fn named(name: &str) -> Option<GroupColor> {
        GroupColor::ALL.into_iter().find(|color| color.name() == name)
    }

    /// sRGB.
    pub fn rgb(self) -> [u8; 3] {
        match self {
            GroupColor::Yellow => [255, 214, 10],
            GroupColor::Dark => [38, 42, 50],
            GroupColor::Orange => [230, 159, 0],
            GroupColor::Sky => [86, 180, 233],
            GroupColor::Green => [0, 158, 115],
            GroupColor::Blue => [0, 114, 178],
            GroupColor::Vermilion => [213, 94, 0],
            GroupColor::Purple => [204, 121, 167],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_color_is_found_by_its_name_and_differs_from_the_others() {
        for (k, color) in GroupColor::ALL.into_iter().enumerate() {
            assert_eq!(GroupColor::named(color.name()), Some(color));
            for other in &GroupColor::ALL[..k] {
                let distance: i32 =
                    (0..3).map(|c| (i32::from(color.rgb()[c]) - i32::from(other.rgb()[c])).pow(2)).sum();
                // Two of the set lie 61 apart (yellow and orange); 40 is plainly more than a shade.
                assert!(distance > 40 * 40, "{} and {} are {distance} apart", color.name(), other.name());
            }
        }
        assert_eq!(GroupColor::named("mauve"), None);
    }
}
