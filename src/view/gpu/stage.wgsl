// What every pass knows of the frame. The fields are those of `frame.rs`, in the same order.
struct Stage {
    view: mat4x4f,          // world to clip space of the picture
    light: mat4x4f,         // world to clip space of the shadow map
    eye: vec4f,             // where the camera stands; w: radius of the scene
    right: vec4f,           // camera axes, w: nearest depth
    up: vec4f,              // w: farthest depth
    back: vec4f,            // w: focal length, device pixels
    window: vec4f,          // device width and height; centre of the free part
    room: vec4f,            // middle of what all figures share, device pixels; its focal length
    ground: vec4f,          // middle of the ground map x, height of the ground y, middle z; w: half its side
    key: vec4f,             // direction to the key light; w: strength of shadows
    lines: vec4f,           // boundary half width, device pixels; wire half width; boundary strength; wire strength
    moment: vec4f,          // share of the later shape; hovered face or -1; hovered label or 0; dither strength
    flow: vec4f,            // linear colour where paint that flows in has not arrived; w: how far it is, 1 for done
    field: vec4f,           // strength of lines of equal value; their half width, device pixels
    key_light: vec4f,       // linear light; w: strength of the rim
    sky_light: vec4f,
    ground_light: vec4f,
    back_middle: vec4f,     // linear background colour in the middle and at the rim
    back_rim: vec4f,
    line_colour: vec4f,
    accents: array<vec4f, 5>,
}

@group(0) @binding(0) var<uniform> stage: Stage;

// sRGB encoding by square roots, which software renderers do far faster than powers; off by less than half a step
// of eight bits wherever it shows (I. Taylor, sRGB approximations for HLSL, 2012).
fn encode(c: vec3f) -> vec3f {
    let x = clamp(c, vec3f(0.0), vec3f(1.0));
    let a = sqrt(x);
    let b = sqrt(a);
    return max(0.662002687 * a + 0.684122060 * b - 0.323583601 * sqrt(b) - 0.0225411470 * x, vec3f(0.0));
}

fn decode(c: vec3f) -> vec3f {
    return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878);
}

// Interleaved gradient noise (J. Jimenez, Next generation post processing in Call of Duty, 2014), 0 to 1.
fn noise(pixel: vec2f) -> f32 {
    return fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
}

fn unpack_direction(e: vec2f) -> vec3f {
    let z = 1.0 - abs(e.x) - abs(e.y);
    let turned = (1.0 - abs(e.yx)) * select(vec2f(-1.0), vec2f(1.0), e >= vec2f(0.0));
    return normalize(vec3f(select(turned, e, z >= 0.0), z));
}

// Where a point on the ground or above it is in the ground map, when the key light throws it down.
fn ground_place(p: vec3f) -> vec2f {
    let height = p.y - stage.ground.y;
    let thrown = p.xz - stage.key.xz / stage.key.y * height;
    return (thrown - stage.ground.xz) / stage.ground.w;
}

struct Screen {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

// One triangle over everything.
@vertex
fn screen(@builtin(vertex_index) i: u32) -> Screen {
    let at = vec2f(f32((i << 1u) & 2u), f32(i & 2u));
    return Screen(vec4f(at * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), 1.0, 1.0), at);
}
