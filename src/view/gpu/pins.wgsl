// Pins: enamelled heads that face the viewer, on quads of the right size on the screen.

struct Pin {
    @location(0) point: vec4f,      // where it sticks; w: radius, device pixels
    @location(1) enamel: vec4f,     // linear colour; w: 0 fixed, 1 proposed, 2 missing
    @location(2) state: vec4f,      // how much of the head is shown; 1 if chosen; 1 if under the pointer
}

struct Head {
    @builtin(position) position: vec4f,
    @location(0) at: vec2f,         // from the middle, in radii; y up
    @location(1) @interpolate(flat) enamel: vec4f,
    @location(2) @interpolate(flat) state: vec4f,
    @location(3) @interpolate(flat) radius: f32,
}

// The quad reaches this far, in radii: there is room for the halo and the shadow.
const REACH = 1.9;

fn head(i: u32, pin: Pin) -> Head {
    let corner = vec2f(f32(i & 1u), f32(i >> 1u)) * 2.0 - 1.0;
    let middle = stage.view * vec4f(pin.point.xyz, 1.0);
    let aside = corner * REACH * pin.point.w * 2.0 / stage.window.xy * middle.w;
    return Head(vec4f(middle.xy + aside, 0.0, middle.w), corner * REACH, pin.enamel, pin.state, pin.point.w);
}

// How much of a pixel is inside an edge at `edge`; all lengths in radii.
fn inside(edge: f32, at: f32, radius: f32) -> f32 {
    return clamp((edge - at) * radius + 0.5, 0.0, 1.0);
}

// Light on clay without gloss, for a normal in the camera's axes.
fn lit_enamel(albedo: vec3f, n: vec3f) -> vec3f {
    let world = stage.right.xyz * n.x + stage.up.xyz * n.y + stage.back.xyz * n.z;
    let wrapped = clamp((dot(world, stage.key.xyz) + 0.35) / 1.35, 0.0, 1.0);
    let sky = stage.sky_light.rgb * (0.5 + 0.5 * world.y);
    let bounce = stage.ground_light.rgb * (0.5 - 0.5 * world.y);
    return albedo * (stage.key_light.rgb * wrapped * 0.8 + (sky + bounce) * 1.05);
}

@vertex
fn pin_vertex(@builtin(vertex_index) i: u32, pin: Pin) -> Head {
    return head(i, pin);
}

// Colour and alpha that replace what is below, premultiplied, gamma encoded as the picture is.
@fragment
fn pin_fragment(in: Head) -> @location(0) vec4f {
    let r = length(in.at);
    let px = in.radius;
    let proposed = in.enamel.w == 1.0;
    let missing = in.enamel.w == 2.0;
    let chosen = in.state.y;
    let hovered = in.state.z;
    // The rim is a ring of pale metal around the enamel, on a thin dark foot.
    let rim_width = 0.15;
    let edge = inside(1.0, r, px);
    let ink = stage.line_colour.rgb;

    // Dome: flat in the middle, falling to the rim; the rim bulges.
    let dir = in.at / max(r, 1e-6);
    let t = clamp(r / (1.0 - rim_width), 0.0, 1.0);
    let dome = normalize(vec3f(dir * t * (0.35 + 0.85 * t * t), 1.0));
    let across = clamp((r - (1.0 - rim_width)) / rim_width, 0.0, 1.0) * 2.0 - 1.0;
    let ring = normalize(vec3f(dir * across * 1.1, 1.0));
    let enamel = lit_enamel(in.enamel.rgb, dome);
    let metal = lit_enamel(vec3f(0.93, 0.91, 0.87), ring);
    let core = inside(1.0 - rim_width, r, px);

    var colour = mix(metal, enamel, core);
    var alpha = edge;
    // A line where enamel meets metal, and another at the foot, give both an edge on any ground.
    let seam = 1.0 - clamp(abs(r - (1.0 - rim_width)) * px - 0.1, 0.0, 1.0);
    colour = mix(colour, ink, 0.35 * seam * edge);
    let foot = inside(1.0, r, px) - inside(1.0 - 1.1 / px, r, px);
    colour = mix(colour, ink, 0.6 * clamp(foot, 0.0, 1.0));
    if proposed {
        // Glass in the colour of the enamel, with a ring of dashes.
        let turn = atan2(in.at.y, in.at.x) / 6.2831853;
        let dash = smoothstep(0.42, 0.5, abs(fract(turn * 9.0) - 0.5) * 2.0 + 0.0);
        let band = inside(1.0, r, px) - inside(0.8, r, px);
        let glass = mix(0.28, 0.42, t);
        colour = mix(enamel * 1.05, mix(in.enamel.rgb * 0.5, in.enamel.rgb, 0.4), clamp(band, 0.0, 1.0));
        alpha = edge * mix(glass, mix(0.3, 1.0, dash), clamp(band, 0.0, 1.0));
    }
    if missing {
        // An empty setting: the rim in the enamel's colour and nothing in it.
        let band = clamp(inside(1.0, r, px) - inside(0.74, r, px), 0.0, 1.0);
        colour = mix(ink, in.enamel.rgb * 0.85, band * (1.0 - 0.5 * clamp(foot, 0.0, 1.0)));
        colour = mix(metal, colour, band);
        alpha = edge * mix(0.65, 1.0, band);
    }

    // Around the head: a soft shadow away from the light, and a ring around what is chosen or pointed at.
    let fall = vec2f(dot(stage.key.xyz, stage.right.xyz), dot(stage.key.xyz, stage.up.xyz)) * -0.16;
    let shadow_r = length(in.at - fall);
    let open = proposed || missing;
    let shade = (1.0 - smoothstep(0.75, 1.45, shadow_r)) * select(0.42, 0.3 * (1.0 - edge), open);
    let halo_at = 1.34;
    let halo = clamp(1.0 - max(abs(r - halo_at) * px - 0.13 * px, 0.0), 0.0, 1.0) * max(chosen, 0.55 * hovered);
    let halo_edge = clamp(1.0 - max(abs(abs(r - halo_at) - 0.15) * px - 0.35, 0.0), 0.0, 1.0) * chosen;

    // Shadow, then halo, then head.
    var out = vec4f(encode(ink * 0.4) * shade, shade);
    let ring_colour = encode(mix(vec3f(0.96), in.enamel.rgb, 0.0));
    out = vec4f(mix(out.rgb, encode(ink), 0.55 * halo_edge), mix(out.a, 1.0, 0.55 * halo_edge));
    out = vec4f(mix(out.rgb, ring_colour, halo), mix(out.a, 1.0, halo));
    out = vec4f(mix(out.rgb, encode(colour), alpha), mix(out.a, 1.0, alpha));
    return out * in.state.x;
}

// What shines through the surface where it hides a pin: a faint ring.
@fragment
fn ghost_fragment(in: Head) -> @location(0) vec4f {
    let r = length(in.at);
    let px = in.radius;
    let ring = clamp(1.0 - max(abs(r - 0.86) * px - 0.75, 0.0), 0.0, 1.0);
    let dark = clamp(1.0 - max(abs(r - 0.86) * px - 1.6, 0.0), 0.0, 1.0);
    let core = inside(0.86, r, px) * 0.16;
    let strong = 0.5 + 0.35 * max(in.state.y, in.state.z);
    var out = vec4f(encode(in.enamel.rgb) * core, core);
    out = vec4f(mix(out.rgb, encode(stage.line_colour.rgb), 0.35 * dark), mix(out.a, 1.0, 0.35 * dark));
    out = vec4f(mix(out.rgb, encode(in.enamel.rgb), ring), mix(out.a, 1.0, ring));
    let halo = clamp(1.0 - max(abs(r - 1.34) * px - 0.07 * px, 0.0), 0.0, 1.0) * in.state.y;
    out = vec4f(mix(out.rgb, vec3f(0.98), halo), mix(out.a, 1.0, halo));
    return out * strong * (1.0 - in.state.x);
}
