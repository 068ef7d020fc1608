// The surface: three corners a face, fetched from textures, and everything that is drawn of it.

@group(1) @binding(0) var faces: texture_2d<u32>;    // corners' drawn vertices
@group(1) @binding(1) var paints: texture_2d<u32>;   // colour and mark; boundary bits and label; values of corners
@group(1) @binding(2) var earlier: texture_2d<u32>;  // a drawn vertex's position (bits) and packed normal
@group(1) @binding(3) var later: texture_2d<u32>;
@group(1) @binding(4) var table: texture_2d<f32>;    // colours of what lies on the vertices

fn texel(i: u32) -> vec2u {
    return vec2u(i & 2047u, i >> 11u);
}

// The two shapes' texels of a corner's drawn vertex.
struct Corner {
    a: vec4u,
    b: vec4u,
}

fn corner(i: u32) -> Corner {
    let face = textureLoad(faces, texel(i / 3u), 0);
    let which = i % 3u;
    let v = texel(select(select(face.x, face.y, which == 1u), face.z, which == 2u));
    return Corner(textureLoad(earlier, v, 0), textureLoad(later, v, 0));
}

fn position_of(c: Corner) -> vec3f {
    return mix(bitcast<vec3f>(c.a.xyz), bitcast<vec3f>(c.b.xyz), stage.moment.x);
}

fn normal_of(c: Corner) -> vec3f {
    let a = unpack_direction(unpack2x16snorm(c.a.w));
    return mix(a, unpack_direction(unpack2x16snorm(c.b.w)), stage.moment.x);
}

// --- shadow map: the surface as the key light sees it

@vertex
fn shadow_vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return stage.light * vec4f(position_of(corner(i)), 1.0);
}

// --- ground map: what is above the ground, by height, lowest first

struct OverGround {
    @builtin(position) position: vec4f,
    @location(0) height: f32,
}

@vertex
fn ground_vertex(@builtin(vertex_index) i: u32) -> OverGround {
    let p = position_of(corner(i));
    let height = max((p.y - stage.ground.y) / stage.eye.w, 0.0);
    return OverGround(vec4f(ground_place(p), clamp(0.3 * height, 0.0, 0.99), 1.0), height);
}

// Red: touching; green: near; blue: anything.
@fragment
fn ground_fragment(in: OverGround) -> @location(0) vec4f {
    let h = max(in.height, 0.0);
    return vec4f(exp(-h * 28.0), exp(-h * 6.0), exp(-h * 0.6), 1.0);
}

// --- depth and normals at half the resolution, for the shade in hollows

struct Deep {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
    @location(1) depth: f32,
}

@vertex
fn depth_vertex(@builtin(vertex_index) i: u32) -> Deep {
    let c = corner(i);
    let p = position_of(c);
    let depth = dot(stage.eye.xyz - p, stage.back.xyz);
    return Deep(stage.view * vec4f(p, 1.0), normal_of(c), (depth - stage.right.w) / (stage.up.w - stage.right.w));
}

@fragment
fn depth_fragment(in: Deep, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let n = in.normal / max(dot(abs(in.normal), vec3f(1.0)), 1e-9) * select(-1.0, 1.0, front);
    let turned = (1.0 - abs(n.yx)) * select(vec2f(-1.0), vec2f(1.0), n.xy >= vec2f(0.0));
    let flat_normal = select(turned, n.xy, n.z >= 0.0);
    let d = clamp(in.depth, 0.0, 0.9999) * 255.0;
    return vec4f(floor(d) / 255.0, fract(d), flat_normal * 0.5 + 0.5);
}

// --- the picture

@group(2) @binding(2) var ground_map: texture_2d<f32>;
@group(2) @binding(3) var ground_sampler: sampler;
@group(2) @binding(4) var hollows: texture_2d<f32>;

// Width of the front of paint that flows in, of the whole way.
const FLOW_FRONT = 0.18;

struct Seen {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) weights: vec3f,
    @location(3) @interpolate(flat) albedo: vec4f,  // w: how much of what lies on the vertices is seen on it
    @location(4) @interpolate(flat) bits: u32,
    @location(5) @interpolate(flat) values: vec2u,  // of the corners; what they mean
}

// How much of the paint has arrived at a face while it flows in: it comes over a few faces at a time.
fn arrived(paint: vec2u) -> f32 {
    let when = f32(paint.y >> 24u) / 255.0;
    return clamp((stage.flow.w * (1.0 + FLOW_FRONT) - when) / FLOW_FRONT, 0.0, 1.0);
}

// Colour of a face: its paint, its mark, and what the pointer does to it; and how much of what lies on the vertices
// is to be added.
fn albedo_of(face: u32, paint: vec4u) -> vec4f {
    let low = vec4u(paint.x, paint.x >> 8u, paint.x >> 16u, paint.x >> 24u) & vec4u(255u);
    var albedo = vec4f(mix(stage.flow.rgb, decode(vec3f(low.xyz) / 255.0), arrived(paint.xy)), 0.0);
    if (paint.w >> 16u) > 0u {
        let share = arrived(paint.xy);
        albedo = vec4f(stage.flow.rgb * (1.0 - share), share);
    }
    if low.w > 0u {
        let accent = stage.accents[min(low.w - 1u, 3u)];
        albedo = mix(albedo, vec4f(accent.rgb, 0.0), accent.a);
    }
    let label = f32((paint.y >> 8u) & 65535u);
    if label > 0.0 && label == stage.moment.z {
        albedo = mix(albedo, vec4f(1.0, 1.0, 1.0, 0.0), 0.12);
    }
    if f32(face) == stage.moment.y {
        // What lies on the vertices is looked at from vertex to vertex: the face only glows a little.
        let strength = select(1.0, 0.35, albedo.w > 0.0);
        albedo = mix(albedo, vec4f(stage.accents[4].rgb, 0.0), stage.accents[4].a * strength);
    }
    return albedo;
}

@vertex
fn picture_vertex(@builtin(vertex_index) i: u32) -> Seen {
    let c = corner(i);
    let p = position_of(c);
    let which = i % 3u;
    let weights = vec3f(f32(which == 0u), f32(which == 1u), f32(which == 2u));
    let paint = textureLoad(paints, texel(i / 3u), 0);
    let bits = select(0u, paint.y & 63u, arrived(paint.xy) > 0.5);
    let albedo = albedo_of(i / 3u, paint);
    return Seen(stage.view * vec4f(p, 1.0), p, normal_of(c), weights, albedo, bits, paint.zw);
}

// How open the surface is to the sky, and the share of the key light that arrives: from the four nearest pixels of
// the half-resolution map, as far as they lie at the same depth.
fn light_here(pixel: vec2f, depth: f32) -> vec2f {
    let size = vec2i(textureDimensions(hollows));
    let at = pixel * 0.5 - 0.5;
    let first = vec2i(floor(at));
    let f = at - floor(at);
    var sum = vec2f(0.0);
    var weight = 0.0;
    for (var k = 0; k < 4; k++) {
        let step = vec2i(k & 1, k >> 1u);
        let h = textureLoad(hollows, clamp(first + step, vec2i(0), size - 1), 0);
        let near = abs(h.y + h.z / 255.0 - depth);
        let bilinear = mix(1.0 - f.x, f.x, f32(step.x)) * mix(1.0 - f.y, f.y, f32(step.y));
        let w = (bilinear + 1e-3) / (1e-3 + near * near * 4000.0);
        sum += w * h.xw;
        weight += w;
    }
    return sum / weight;
}

// Distance in pixels from the corner where weight a falls from 1 and b, c are 0.
fn from_corner(b: f32, c: f32, gb: vec2f, gc: vec2f) -> f32 {
    let d = gb.x * gc.y - gb.y * gc.x;
    return length(vec2f(b * gc.y - c * gb.y, c * gb.x - b * gc.x)) / max(abs(d), 1e-12);
}

// What lies on the vertices: linear colour, and how dark a line is drawn here.
fn on_vertices(values: vec2u, weights: vec3f, dx: vec3f, dy: vec3f) -> vec4f {
    let v = vec3u(values.x & 65535u, values.x >> 16u, values.y & 65535u);
    if (values.y >> 16u) == 2u {
        // The group of the nearest corner; a line where two corners of different groups are as near.
        let ab = weights.x - weights.y;
        let bc = weights.y - weights.z;
        let ca = weights.z - weights.x;
        let nearest = select(select(v.z, v.y, bc >= 0.0), v.x, ab >= 0.0 && ca <= 0.0);
        let px = vec3f(length(vec2f(dx.x - dx.y, dy.x - dy.y)), length(vec2f(dx.y - dx.z, dy.y - dy.z)), length(vec2f(dx.z - dx.x, dy.z - dy.x)));
        let far = abs(vec3f(ab, bc, ca)) / max(px, vec3f(1e-12));
        var line = 1e9;
        line = select(line, min(line, far.x), v.x != v.y && min(weights.x, weights.y) >= weights.z);
        line = select(line, min(line, far.y), v.y != v.z && min(weights.y, weights.z) >= weights.x);
        line = select(line, min(line, far.z), v.z != v.x && min(weights.z, weights.x) >= weights.y);
        let dark = clamp(stage.lines.x + 0.5 - line, 0.0, 1.0) * stage.lines.z * stage.line_colour.a;
        return vec4f(decode(textureLoad(table, vec2u(nearest, 0u), 0).rgb), dark);
    }
    if any(v == vec3u(65535u)) {
        return vec4f(stage.flow.rgb, 0.0);
    }
    let corners = vec3f(v) / 65534.0;
    let value = clamp(dot(corners, weights), 0.0, 1.0);
    let place = value * 255.0;
    let low = min(u32(place), 254u);
    let colour = mix(textureLoad(table, vec2u(low, 0u), 0).rgb, textureLoad(table, vec2u(low + 1u, 0u), 0).rgb, place - f32(low));
    // A line at every tenth; where they would crowd, they fade, and so they do at both ends, which are plateaus.
    let steep = max(length(vec2f(dot(corners, dx), dot(corners, dy))) * 10.0, 1e-9);
    let step = value * 10.0;
    let off = abs(fract(step + 0.5) - 0.5) / steep;
    let ends = smoothstep(0.4, 0.6, step) * smoothstep(0.4, 0.6, 10.0 - step);
    let dark = clamp(stage.field.y + 0.5 - off, 0.0, 1.0) * stage.field.x * ends * smoothstep(0.25, 0.1, steep);
    return vec4f(decode(colour), dark);
}

@fragment
fn picture_fragment(in: Seen, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let dx = dpdx(in.weights);
    let dy = dpdy(in.weights);
    let pixel = in.position.xy;

    var albedo = in.albedo.rgb;
    var drawn = 0.0;
    if in.albedo.a > 0.0 {
        let paint = on_vertices(in.values, in.weights, dx, dy);
        albedo += in.albedo.a * paint.rgb;
        drawn = in.albedo.a * paint.a;
    }

    // Lines: distance to the three edges and corners in pixels.
    let grad = vec3f(length(vec2f(dx.x, dy.x)), length(vec2f(dx.y, dy.y)), length(vec2f(dx.z, dy.z)));
    let far = max(in.weights, vec3f(0.0)) / max(grad, vec3f(1e-12));
    let bits = in.bits;
    var boundary = 0.0;
    if bits != 0u {
        var line = 1e9;
        line = select(line, min(line, far.z), (bits & 1u) != 0u);
        line = select(line, min(line, far.x), (bits & 2u) != 0u);
        line = select(line, min(line, far.y), (bits & 4u) != 0u);
        let gx = vec2f(dx.x, dy.x);
        let gy = vec2f(dx.y, dy.y);
        let gz = vec2f(dx.z, dy.z);
        if (bits & 8u) != 0u {
            line = min(line, from_corner(in.weights.y, in.weights.z, gy, gz));
        }
        if (bits & 16u) != 0u {
            line = min(line, from_corner(in.weights.z, in.weights.x, gz, gx));
        }
        if (bits & 32u) != 0u {
            line = min(line, from_corner(in.weights.x, in.weights.y, gx, gy));
        }
        boundary = clamp(stage.lines.x + 0.5 - line, 0.0, 1.0) * stage.lines.z;
    }
    var wire = 0.0;
    if stage.lines.w > 0.0 {
        let wire_far = min(far.x, min(far.y, far.z));
        // Where faces are smaller than a few pixels, wires would cover everything: they fade.
        let height = 1.0 / max(max(grad.x, grad.y), max(grad.z, 1e-6));
        wire = clamp(stage.lines.y + 0.5 - wire_far, 0.0, 1.0) * stage.lines.w * smoothstep(1.5, 7.0, height);
    }

    // Light.
    let n = normalize(in.normal + vec3f(0.0, 1e-9, 0.0));
    let towards = normalize(stage.eye.xyz - in.world);
    // Seen from inside, the light on the other side counts. At the silhouette that comes softly, or the outline would
    // be dotted where a back face peeps over it.
    let facing = dot(n, towards);
    let inside = 1.0 - select(smoothstep(-0.1, 0.02, facing), smoothstep(-0.3, -0.2, facing), front);
    let upward = n.y * (1.0 - 2.0 * inside);
    let depth = (dot(stage.eye.xyz - in.world, stage.back.xyz) - stage.right.w) / (stage.up.w - stage.right.w);
    let lamp = dot(n, stage.key.xyz);
    let sides = clamp((vec2f(lamp, -lamp) + 0.3) / 1.3, vec2f(0.0), vec2f(1.0));
    let wrapped = mix(sides.x, sides.y, inside);
    var arrives = vec2f(1.0);
    // Plain drawing has no shadows.
    if stage.key.w > 0.0 {
        arrives = light_here(pixel, depth);
    }
    let hollow = arrives.x;
    let shade = mix(1.0, arrives.y, stage.key.w);
    let key = stage.key_light.rgb * wrapped * (0.3 + 0.7 * wrapped) * shade;
    // What stands under the body or near the ground sees less of both sky and lit ground.
    let above = (in.world.y - stage.ground.y) / stage.eye.w;
    let below = textureSampleLevel(ground_map, ground_sampler, ground_place(in.world) * vec2f(0.5, -0.5) + 0.5, 0.0);
    let covered = 1.0 - 0.55 * below.z * exp(-1.5 * max(above, 0.0));
    let sky = stage.sky_light.rgb * (0.5 + 0.5 * upward);
    let bounce = stage.ground_light.rgb * (0.5 - 0.5 * upward) * covered * mix(0.45, 1.0, smoothstep(0.0, 0.35, above));
    let turned = 1.0 - clamp(facing * (1.0 - 2.0 * inside), 0.0, 1.0);
    let edge = turned * turned * turned * (0.5 + 0.5 * upward);
    let rim = stage.key_light.rgb * (stage.key_light.w * edge);
    // Light that has gone from clay to clay takes on its colour: hollows are warm, not grey.
    let tinted = hollow * (0.85 + 0.15 * hollow + 0.6 * (1.0 - hollow) * albedo);
    var colour = albedo * (key * mix(vec3f(1.0), tinted, 0.45) + (sky + bounce) * tinted + rim);

    colour = mix(colour, albedo * 0.25, wire);
    colour = mix(colour, stage.line_colour.rgb, drawn);
    colour = mix(colour, stage.line_colour.rgb, boundary * stage.line_colour.a);
    return vec4f(encode(colour) + (noise(pixel) - 0.5) * stage.moment.w, 1.0);
}

// --- the quiet studio around it

@fragment
fn studio_fragment(in: Screen) -> @location(0) vec4f {
    let pixel = in.position.xy;
    let aside = (pixel - stage.window.zw) / stage.back.w;
    // Brightest a little below the middle, as if a lamp stood over the figure.
    let off = length(((pixel - stage.room.xy) / stage.room.z - vec2f(0.0, 0.06)) * vec2f(0.85, 1.0));
    var colour = mix(stage.back_middle.rgb, stage.back_rim.rgb, smoothstep(0.0, 0.75, off));
    let ray = stage.right.xyz * aside.x - stage.up.xyz * aside.y - stage.back.xyz;
    let fall = stage.ground.y - stage.eye.y;
    if ray.y * fall > 0.0 && fall < 0.0 {
        let p = stage.eye.xyz + ray * (fall / ray.y);
        let place = (p.xz - stage.ground.xz) / stage.ground.w;
        if max(abs(place.x), abs(place.y)) < 1.0 {
            let s = textureSampleLevel(ground_map, ground_sampler, place * vec2f(0.5, -0.5) + 0.5, 0.0);
            let rim = smoothstep(1.0, 0.7, length(place));
            let dark = (1.0 - 0.6 * s.x) * (1.0 - 0.5 * s.y) * (1.0 - 0.45 * s.z);
            // Seen from very low, the ground is a line: the shadow fades.
            let grazing = smoothstep(0.0, 0.06, -ray.y / length(ray));
            colour *= mix(vec3f(1.0), vec3f(dark) + (1.0 - dark) * dark * vec3f(0.06, 0.0, -0.05), rim * grazing * stage.back_rim.w);
        }
    }
    return vec4f(encode(colour) + (noise(pixel) - 0.5) * stage.moment.w, 1.0);
}
