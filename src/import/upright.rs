//! Which way is up: files say it by their format or not at all, and all that comes after the import has y up, as glTF has
//! it.
//!
//! The turns are those by which COLLADA tells its axes (Khronos Group, *COLLADA 1.4.1 Specification*, 2008, `up_axis`): with
//! z up, x stays to the right and y goes away from the viewer.

use super::Imported;
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// An axis of a file that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Up {
    /// y, as in glTF: nothing is turned.
    #[default]
    #[serde(rename = "y")]
    Y,
    /// z, as in most programs for construction and printing.
    #[serde(rename = "z")]
    Z,
    /// x.
    #[serde(rename = "x")]
    X,
    /// Against y.
    #[serde(rename = "-y")]
    NegY,
    /// Against z.
    #[serde(rename = "-z")]
    NegZ,
    /// Against x.
    #[serde(rename = "-x")]
    NegX,
}

impl Up {
    /// Where a point of the file is when the axis is up, in the file's units.
    pub fn raised(self, point: DVec3) -> DVec3 {
        self.turn() * point
    }

    /// The point of the file that is there when the axis is up: undoes [`Up::raised`].
    pub fn lowered(self, point: DVec3) -> DVec3 {
        self.turn().transpose() * point
    }

    /// A rotation that carries axes to axes, so that no coordinate is rounded. The one that is up becomes y.
    fn turn(self) -> DMat3 {
        match self {
            Self::Y => DMat3::IDENTITY,
            Self::Z => DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
            Self::X => DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z),
            Self::NegY => DMat3::from_cols(DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z),
            Self::NegZ => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
            Self::NegX => DMat3::from_cols(DVec3::NEG_Y, DVec3::X, DVec3::Z),
        }
    }
}

/// Stands what was read on its feet: the reference and all poses are turned, `up` being up, or what the format says. A look
/// has nothing to turn: it keeps no directions.
pub fn upright(mut imported: Imported, up: Option<Up>) -> Imported {
    imported.up = up.unwrap_or(imported.up);
    if imported.up != Up::Y {
        for positions in imported.sequence.positions_mut() {
            positions.iter_mut().for_each(|point| *point = imported.up.raised(*point));
        }
    }
    imported
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [(Up, DVec3); 6] = [
        (Up::Y, DVec3::Y),
        (Up::Z, DVec3::Z),
        (Up::X, DVec3::X),
        (Up::NegY, DVec3::NEG_Y),
        (Up::NegZ, DVec3::NEG_Z),
        (Up::NegX, DVec3::NEG_X),
    ];

    #[test]
    fn each_axis_comes_to_be_y_by_a_turn_and_not_by_a_mirror() {
        for (up, axis) in ALL {
            assert_eq!(up.raised(axis), DVec3::Y, "{up:?}");
            assert_eq!(up.turn().determinant(), 1.0, "{up:?}");
        }
    }

    #[test]
    fn with_z_up_right_stays_right() {
        assert_eq!(Up::Z.raised(DVec3::new(1.0, 2.0, 3.0)), DVec3::new(1.0, 3.0, -2.0));
    }

    #[test]
    fn there_and_back_no_coordinate_changes() {
        let point = DVec3::new(0.1, -2.0e-300, 3.0e300);
        for (up, _) in ALL {
            assert_eq!(up.lowered(up.raised(point)), point, "{up:?}");
        }
    }

    #[test]
    fn axes_are_called_by_their_letters() {
        let names = ALL.map(|(up, _)| serde_json::to_value(up).unwrap());
        assert_eq!(names, ["y", "z", "x", "-y", "-z", "-x"]);
    }
}
