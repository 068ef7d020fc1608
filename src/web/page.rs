//! The page's bundle: one class, `Viewport`, a canvas with a figure on it; and the colours that there are without one.
//!
//! Lengths are CSS pixels from the canvas's top left corner. What cannot be done is thrown as one sentence.

use crate::view::colormap::ColourMap;
use crate::view::gpu::Renderer;
use crate::view::gpu::device::{Backend, Gpu};
use crate::view::motion::{Moment, Motion};
use crate::view::palette;
use crate::view::pins;
use crate::view::stage::Stage;
use js_sys::{Error, Float32Array, Function, Reflect, Uint8Array};
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

/// Writes a sentence to the browser's console.
pub fn log(message: &str) {
    web_sys::console::error_1(&JsValue::from_str(message));
}

/// Runs once when the bundle is loaded.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|info| log(&info.to_string())));
}

/// A canvas with a figure on it.
#[wasm_bindgen]
pub struct Viewport {
    canvas: HtmlCanvasElement,
    renderer: Renderer,
    stage: Stage,
    /// The shapes that the GPU has in its two places.
    places: [Option<usize>; 2],
    /// The moment that the GPU's skinned shape is of.
    skinned: Option<Moment>,
    /// Whether the camera was ever set.
    framed: bool,
    device_size: (u32, u32),
}

#[wasm_bindgen]
impl Viewport {
    /// Opens `canvas` with a backend, `webgpu` or `webgl2`. Rejects with a sentence.
    pub async fn create(canvas: HtmlCanvasElement, backend: String) -> Result<Viewport, JsValue> {
        let kind = match backend.as_str() {
            "webgpu" => Backend::WebGpu,
            "webgl2" => Backend::WebGl2,
            _ => return Err(sentence("The backend must be webgpu or webgl2.")),
        };
        let gpu = Gpu::open(canvas.clone(), kind).await.map_err(|e| sentence(&e))?;
        Ok(Self {
            canvas,
            renderer: Renderer::new(gpu),
            stage: Stage::default(),
            places: [None; 2],
            skinned: None,
            framed: false,
            device_size: (0, 0),
        })
    }

    /// `webgpu` or `webgl2`.
    pub fn backend(&self) -> String {
        match self.renderer.gpu().backend {
            Backend::WebGpu => "webgpu".into(),
            Backend::WebGl2 => "webgl2".into(),
        }
    }

    /// Whether the device is lost: free this viewport and make another on a new canvas.
    pub fn lost(&self) -> bool {
        if self.renderer.gpu().lost() {
            return true;
        }
        self.renderer.gpu().backend == Backend::WebGl2 && self.context_lost().unwrap_or(false)
    }

    fn context_lost(&self) -> Option<bool> {
        let context = self.canvas.get_context("webgl2").ok()??;
        let asks = Reflect::get(&context, &"isContextLost".into()).ok()?.dyn_into::<Function>().ok()?;
        asks.call0(&context).ok()?.as_bool()
    }

    /// Tells the canvas's size on the page.
    ///
    /// A canvas whose size in device pixels changes is cleared: whether it was, so that the caller draws before the
    /// page is next shown.
    pub fn resize(&mut self, width: f32, height: f32, device_pixel_ratio: f32) -> bool {
        self.stage.set_window(width, height, device_pixel_ratio);
        let ratio = self.stage.pixel_ratio();
        let pixels = |x: f32| (x * ratio).round().clamp(1.0, self.renderer.gpu().longest as f32) as u32;
        let size = (pixels(self.stage.window().width), pixels(self.stage.window().height));
        let cleared = size != self.device_size;
        if cleared {
            self.device_size = size;
            self.canvas.set_width(size.0);
            self.canvas.set_height(size.1);
            self.renderer.resize(size.0, size.1);
        }
        cleared
    }

    /// Puts a mesh on the stage: 3·#F vertex numbers and 3·#V coordinates.
    pub fn set_mesh(&mut self, faces: &[u32], reference: &[f32]) -> Result<(), JsValue> {
        if !self.renderer.gpu().holds(faces.len()) {
            return Err(sentence("This mesh has more faces than this browser's graphics can hold."));
        }
        self.stage.set_motion(Motion::new(faces, reference).map_err(sentence)?);
        self.places = [None; 2];
        if !self.framed {
            self.frame();
        }
        Ok(())
    }

    /// Gives the mesh poses: T·3·#V coordinates, or none.
    pub fn set_poses(&mut self, positions: &[f32]) -> Result<(), JsValue> {
        self.places = [None; 2];
        self.stage.set_poses(positions).map_err(sentence)
    }

    /// Has a skin move the mesh instead of poses. Each vertex follows `each` (at most 16) of `handles` handles:
    /// `indices` and `weights` are #V·`each` numbers, weights of a vertex add up to 1. `matrices` is T·`handles`·12
    /// numbers, a 3×4 matrix row by row for each pose and handle. While it plays, a frame uploads only as many
    /// matrices as there are handles.
    pub fn set_skin(
        &mut self,
        handles: usize,
        indices: &[u16],
        weights: &[f32],
        each: usize,
        matrices: &[f32],
    ) -> Result<(), JsValue> {
        if !self.renderer.gpu().holds(self.stage.motion().faces().len().saturating_mul(3 * each.div_ceil(4))) {
            return Err(sentence("This mesh has more vertices than this browser's graphics can move."));
        }
        self.places = [None; 2];
        self.stage.set_skin(handles, indices, weights, each, matrices).map_err(sentence)
    }

    /// Moves the skin by other matrices: T·handles·12 numbers.
    pub fn set_maps(&mut self, matrices: &[f32]) -> Result<(), JsValue> {
        self.stage.set_maps(matrices).map_err(sentence)
    }

    /// Bytes that the last frame uploaded to move the vertices of a skin.
    pub fn moved_bytes(&self) -> usize {
        self.renderer.moved()
    }

    /// Sets the time in poses: 2.25 is a quarter of the way from pose 2 to pose 3, −1 the reference.
    pub fn set_time(&mut self, time: f32) {
        self.stage.set_time(time);
    }

    /// Sets whether the last pose goes over into the first.
    pub fn set_loop(&mut self, on: bool) {
        self.stage.set_loop(on);
    }

    /// Bare clay.
    pub fn paint_clay(&mut self) {
        self.stage.paint.clay();
        self.stage.repaint();
    }

    /// Parts: #F numbers below `count`.
    pub fn paint_parts(&mut self, labels: &[u32], count: usize) -> Result<(), JsValue> {
        self.stage.paint_parts(labels, count).map_err(sentence)
    }

    /// A field: #F numbers, shown from `low` to `high` with `viridis`, `cividis` or `diverging`.
    pub fn paint_scalar(&mut self, values: &[f32], low: f32, high: f32, map: &str) -> Result<(), JsValue> {
        let map = colour_map_named(map)?;
        self.stage.paint.scalar(values, low, high, map).map_err(sentence)?;
        self.stage.repaint();
        Ok(())
    }

    /// A field on the vertices: #V numbers, shown from `low` to `high`; what is not a number is clay.
    pub fn paint_vertices(&mut self, values: &[f32], low: f32, high: f32, map: &str) -> Result<(), JsValue> {
        self.stage.paint_vertices(values, low, high, colour_map_named(map)?).map_err(sentence)
    }

    /// Groups of vertices: #V numbers below `count`.
    pub fn paint_groups(&mut self, labels: &[u32], count: usize) -> Result<(), JsValue> {
        self.stage.paint_groups(labels, count).map_err(sentence)
    }

    /// Three sRGB bytes for each group that is painted.
    pub fn group_colours(&self) -> Uint8Array {
        Uint8Array::from(self.stage.paint.group_colours().as_flattened())
    }

    /// Sets whether fields on the vertices have lines at every tenth.
    pub fn set_contours(&mut self, on: bool) {
        self.stage.set_contours(on);
    }

    /// A set of faces: #F numbers, 0 outside.
    pub fn paint_set(&mut self, mask: &[u8]) -> Result<(), JsValue> {
        self.stage.paint.set(mask).map_err(sentence)?;
        self.stage.repaint();
        Ok(())
    }

    /// Lets the paint flow in from some faces over clay; `set_flow` says how far it has come.
    pub fn flow_from(&mut self, faces: &[u32]) {
        self.stage.flow_from(faces);
    }

    /// Sets how far the paint has flowed, from 0 to 1 (everywhere).
    pub fn set_flow(&mut self, share: f32) {
        self.stage.set_flow(share);
    }

    /// Sets whether lines are drawn where paint labels differ.
    pub fn set_boundaries(&mut self, on: bool) {
        self.stage.set_boundaries(on);
    }

    /// Sets whether edges are drawn.
    pub fn set_wireframe(&mut self, on: bool) {
        self.stage.set_wires(on);
    }

    /// Sets whether the figure throws no shadow on itself: for machines that are slow with the full picture.
    pub fn set_plain(&mut self, on: bool) {
        self.stage.set_plain(on);
    }

    /// Marks exactly these faces with a style (0 to 3); with none, the style's marks go.
    pub fn mark_faces(&mut self, faces: &[u32], style: usize) {
        self.stage.paint.mark(faces, style);
        self.stage.repaint();
    }

    /// Shows which face is under the pointer; −1 for none.
    pub fn hover(&mut self, face: i32) {
        self.stage.hover(usize::try_from(face).ok());
    }

    /// What is under a point: face, three weights, x, y, z in the pose that is shown.
    pub fn pick(&mut self, x: f32, y: f32) -> Option<Float32Array> {
        let hit = self.stage.pick(x, y)?;
        let [a, b, c] = hit.weights;
        let p = hit.point;
        Some(Float32Array::from(&[hit.face as f32, a, b, c, p.x, p.y, p.z][..]))
    }

    /// Where some vertices are in the pose that is shown: three coordinates each, 0 for one that does not exist.
    pub fn vertices(&self, numbers: &[u32]) -> Float32Array {
        let found: Vec<f32> =
            self.stage.places(numbers).iter().flat_map(|p| p.unwrap_or_default().to_array()).collect();
        Float32Array::from(&found[..])
    }

    /// Where points of the world are on the canvas: x, y and depth each; what is behind the camera has no positive depth.
    pub fn project(&self, points: &[f32]) -> Float32Array {
        let seen: Vec<f32> = points.as_chunks().0.iter().flat_map(|&p| self.stage.project(p.into())).collect();
        Float32Array::from(&seen[..])
    }

    /// Puts pins on the surface in place of those there are, eight numbers each: see [`pins::read`].
    pub fn set_pins(&mut self, numbers: &[f32]) -> Result<(), JsValue> {
        self.stage.set_pins(pins::read(numbers).map_err(sentence)?);
        Ok(())
    }

    /// Five numbers for each pin: x and y of its head's middle, its depth (not above 0 behind the camera), 1 if the
    /// surface does not hide it, and the head's radius; all 0 for a pin that the mesh has no place for.
    pub fn pin_positions(&mut self) -> Float32Array {
        let numbers: Vec<f32> = self
            .stage
            .pin_spots()
            .flat_map(|(spot, seen)| {
                spot.map_or([0.0; 5], |s| [s.x, s.y, s.depth, f32::from(u8::from(seen)), s.radius])
            })
            .collect();
        Float32Array::from(&numbers[..])
    }

    /// The pin under a point or within `reach` of it.
    pub fn pick_pin(&mut self, x: f32, y: f32, reach: f32) -> Option<usize> {
        self.stage.pick_pin(x, y, reach)
    }

    /// Three sRGB bytes for each part.
    pub fn part_colours(&self) -> Uint8Array {
        Uint8Array::from(self.stage.paint.part_colours().as_flattened())
    }

    /// A colour map as 256 times three sRGB bytes.
    pub fn colour_map(&self, name: &str) -> Result<Uint8Array, JsValue> {
        Ok(Uint8Array::from(colour_map_named(name)?.table().as_flattened()))
    }

    /// Turns by a drag.
    pub fn orbit(&mut self, dx: f32, dy: f32) {
        self.stage.camera.orbit(dx, dy);
        self.moved();
    }

    /// Moves with a drag.
    pub fn pan(&mut self, dx: f32, dy: f32) {
        let (window, ball) = (*self.stage.window(), self.stage.ball());
        self.stage.camera.pan(&window, ball, dx, dy);
        self.moved();
    }

    /// Comes nearer by a factor (above 1) or goes away, towards a point.
    pub fn zoom(&mut self, factor: f32, x: f32, y: f32) {
        let (window, ball) = (*self.stage.window(), self.stage.ball());
        self.stage.camera.zoom(&window, ball, factor, x, y);
        self.moved();
    }

    /// Fits the whole motion into what panels leave free, looking in the same direction.
    pub fn frame(&mut self) {
        self.stage.frame_all();
        self.framed = true;
    }

    /// Turns and comes nearer so that as many of these faces as can be are seen, with room around them.
    pub fn frame_faces(&mut self, faces: &[u32]) {
        self.stage.frame_faces(faces);
        self.framed = true;
    }

    /// The camera as six numbers that show any figure in the same way, whatever its size and place.
    pub fn camera(&self) -> Float32Array {
        Float32Array::from(&self.stage.camera_numbers()[..])
    }

    /// Sets the camera from the numbers of `camera()`; other numbers change nothing.
    pub fn set_camera(&mut self, numbers: &[f32]) {
        if self.stage.set_camera_numbers(numbers) {
            self.moved();
        }
    }

    fn moved(&mut self) {
        self.framed = true;
        self.stage.redraw();
    }

    /// Sets the dark or the light studio.
    pub fn set_theme(&mut self, dark: bool) {
        self.stage.set_dark(dark);
    }

    /// Tells what panels cover of the canvas.
    pub fn set_insets(&mut self, left: f32, top: f32, right: f32, bottom: f32) {
        self.stage.set_insets([left, top, right, bottom]);
    }

    /// Tells how far the room that this canvas shows a part of is from its left, top, right and bottom edge: see
    /// [`Stage::set_room`]. Without four numbers it is a room of its own.
    pub fn set_room(&mut self, margins: &[f32]) {
        self.stage.set_room(margins.try_into().ok());
    }

    /// Makes the next `render` draw in any case. The canvas keeps its picture until the page is next shown: for a
    /// screenshot, call `redraw`, `render` and `canvas.toBlob` one after another.
    pub fn redraw(&mut self) {
        self.stage.redraw();
    }

    /// Whether `render` would draw.
    pub fn stale(&self) -> bool {
        self.stage.stale().picture
    }

    /// How many frames the graphics have been given that they have not finished yet.
    pub fn under_way(&self) -> usize {
        self.renderer.gpu().under_way()
    }

    /// Draws a frame if anything changed since the last; whether it did.
    pub fn render(&mut self) -> bool {
        if !self.stage.stale().picture || self.device_size.0 == 0 || self.renderer.gpu().lost() {
            return false;
        }
        let stale = self.stage.take_stale();
        if stale.surface {
            if let Err(problem) = self.renderer.set_surface(self.stage.surface()) {
                log(problem);
            }
            self.places = [None; 2];
        }
        if stale.surface || stale.paint {
            let words = self.stage.words();
            self.renderer.write_paint(&words, self.stage.paint.table().as_deref());
        }
        if stale.surface || stale.skin {
            self.upload_skin();
        }
        let moment = self.stage.moment();
        let maps = self.stage.motion().maps(moment);
        if maps.is_empty() {
            self.upload_shapes();
        }
        let again = self.stage.look(&maps);
        self.renderer.write_pins(&self.stage.pin_floats());
        let frame = self.stage.frame();
        let moves = stale.surface || stale.skin || stale.maps || self.skinned != Some(moment);
        let drawn = self.renderer.draw(&frame, if moves { &maps } else { &[] });
        self.skinned = if drawn { Some(moment) } else { None };
        if again || !drawn {
            self.stage.redraw();
        }
        drawn
    }

    /// Gives the GPU what the vertices follow and the reference, where a skin moves them.
    fn upload_skin(&mut self) {
        self.skinned = None;
        self.places = [None; 2];
        let skinned = self.stage.motion().skin().is_some();
        if skinned {
            let (surface, positions, normals) = self.stage.shape(0);
            self.renderer.write_shape(1, surface, positions, normals);
            self.renderer.set_earlier(0);
        }
        let (surface, skin) = self.stage.skinned();
        if let Err(problem) = self.renderer.set_skin(surface, skin) {
            log(problem);
        }
    }

    /// Sees to it that the GPU has the two shapes of the moment, and knows which is the earlier.
    fn upload_shapes(&mut self) {
        let moment = self.stage.moment();
        let held = |places: &[Option<usize>; 2], shape| places.iter().position(|&p| p == Some(shape));
        let earlier = held(&self.places, moment.from).unwrap_or_else(|| match held(&self.places, moment.to) {
            Some(place) if moment.to != moment.from => 1 - place,
            _ => 0,
        });
        for (place, shape) in [(earlier, moment.from), (1 - earlier, moment.to)] {
            if self.places[place] != Some(shape) && !(place != earlier && moment.to == moment.from) {
                let (surface, positions, normals) = self.stage.shape(shape);
                self.renderer.write_shape(place, surface, positions, normals);
                self.places[place] = Some(shape);
            }
        }
        self.renderer.set_earlier(earlier);
    }
}

/// Three sRGB bytes for each of the first `count` pin colours.
#[wasm_bindgen]
pub fn pin_colours(count: u32) -> Uint8Array {
    Uint8Array::from((0..count).flat_map(pins::colour).collect::<Vec<u8>>().as_slice())
}

/// Three sRGB bytes for each of the parts `labels` (#F part numbers) of a mesh with these faces (#F × 3), where there is
/// no picture of it.
#[wasm_bindgen]
pub fn part_colours(faces: &[u32], labels: &[u32]) -> Result<Uint8Array, JsValue> {
    let faces = faces.as_chunks().0;
    if faces.len() != labels.len() {
        return Err(sentence("The parts are those of another mesh."));
    }
    Ok(Uint8Array::from(palette::part_colours(faces, labels).as_flattened()))
}

fn colour_map_named(name: &str) -> Result<ColourMap, JsValue> {
    ColourMap::named(name).ok_or_else(|| sentence("The colour map must be viridis, cividis or diverging."))
}

fn sentence(text: &str) -> JsValue {
    Error::new(text).into()
}
