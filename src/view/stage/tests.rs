//! What holds for every stage.

use super::*;

/// A tetrahedron that rises by 1 a pose.
fn stage() -> Stage {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut stage = Stage::default();
    stage.set_window(800.0, 600.0, 2.0);
    stage.set_motion(Motion::new(&[0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3], corners.as_flattened()).unwrap());
    let pose = |k: i32| corners.iter().flat_map(move |c| [c[0], c[1] + k as f32, c[2]]);
    stage.set_poses(&(0..3).flat_map(pose).collect::<Vec<f32>>()).unwrap();
    stage
}

#[test]
fn a_framed_figure_is_picked_where_it_is_drawn() {
    let mut stage = stage();
    for time in [-1.0, 0.0, 1.5] {
        stage.set_time(time);
        stage.frame_all();
        let shift = Vec3::Y * time.max(0.0);
        let middle = Vec3::splat(1.0 / 3.0) + shift;
        let at = stage.frame().view.project_point3(middle);
        let hit = stage.pick((at.x + 1.0) * 400.0, (1.0 - at.y) * 300.0).unwrap();
        assert_eq!(hit.face, 3);
        assert!(hit.point.distance(middle) < 1e-3);
        assert_eq!(stage.pick(1.0, 1.0), None);
    }
}

#[test]
fn a_reference_that_is_a_little_taller_is_framed_with_the_motion() {
    for (height, seen) in [(1.2_f32, true), (9.0, false)] {
        let mut stage = stage();
        let corners = |y: f32| [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, 1.0];
        let mut motion = Motion::new(&[0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3], &corners(height)).unwrap();
        motion.set_poses(&corners(1.0)).unwrap();
        stage.set_motion(motion);
        stage.set_time(0.0);
        stage.frame_all();
        let top = stage.frame().view.project_point3(Vec3::Y * height);
        assert_eq!(top.y.abs() < 1.0, seen, "{top}");
    }
}

#[test]
fn windows_beside_each_other_share_the_light_of_their_room() {
    // The right one begins where the left one has 700 of its 800 pixels.
    let [mut left, mut right] = [stage(), stage()];
    right.set_window(600.0, 600.0, 2.0);
    left.set_room(Some([100.0, 0.0, -500.0, 80.0]));
    right.set_room(Some([-600.0, 0.0, 0.0, 80.0]));
    let (a, b) = (left.frame().room, right.frame().room);
    assert_eq!((a.x - 2.0 * 700.0, a.y, a.z), (b.x, b.y, b.z));
    assert_ne!(left.frame().window.z, a.x);
    left.set_room(None);
    assert_eq!(left.frame().room.x, left.frame().window.z);
}

#[test]
fn only_changes_make_the_picture_stale() {
    let mut stage = stage();
    stage.take_stale();
    stage.set_time(-1.0);
    stage.set_dark(false);
    stage.hover(None);
    stage.set_insets([0.0; 4]);
    assert!(!stage.stale().picture);
    stage.set_time(0.5);
    assert_eq!(stage.take_stale(), Stale { picture: true, ..Stale::NOTHING });
    stage.paint_parts(&[0, 0, 1, 1], 2).unwrap();
    assert!(stage.stale().paint && stage.stale().picture);
}

#[test]
fn the_ground_is_the_lowest_point_of_the_motion() {
    let mut stage = stage();
    stage.set_time(2.0);
    assert_eq!(stage.frame().ground.y, 0.0);
    assert!(stage.frame().floats().iter().all(|x| x.is_finite()));
}

#[test]
fn an_empty_stage_has_a_frame() {
    let mut stage = Stage::default();
    stage.set_window(f32::NAN, 0.0, -1.0);
    stage.frame_all();
    assert!(stage.frame().floats().iter().all(|x| x.is_finite()));
    assert!(stage.words().is_empty());
    assert_eq!(stage.pick(0.0, 0.0), None);
}

#[test]
fn shapes_have_a_normal_for_each_drawn_vertex() {
    let mut stage = stage();
    let (surface, positions, normals) = stage.shape(2);
    assert_eq!((positions.len(), normals.len()), (4, surface.vertex.len()));
    assert_eq!(stage.shape(99).2.len(), 0);
}
