// Passes from picture to picture: the blur of the ground map, the shade in hollows and its blur.

@group(1) @binding(0) var source: texture_2d<f32>;

// --- ground map: three Gaussians in one, the wider the farther above the ground the shadow was thrown

fn spread(at: vec2i, along: vec2i) -> vec4f {
    let size = vec2i(textureDimensions(source));
    var sum = vec4f(0.0);
    var weight = vec4f(0.0);
    for (var k = -13; k <= 13; k++) {
        let x = f32(k);
        let w = exp(-x * x / (2.0 * vec4f(1.0, 11.0, 46.0, 1.0)));
        let p = at + along * k;
        let inside = all(p >= vec2i(0)) && all(p < size);
        sum += select(vec4f(0.0), w * textureLoad(source, clamp(p, vec2i(0), size - 1), 0), inside);
        weight += w;
    }
    return sum / weight;
}

@fragment
fn spread_across(in: Screen) -> @location(0) vec4f {
    return spread(vec2i(in.position.xy), vec2i(1, 0));
}

@fragment
fn spread_down(in: Screen) -> @location(0) vec4f {
    return spread(vec2i(in.position.xy), vec2i(0, 1));
}

// --- light at half the resolution: shade in hollows and the shadow of the key light

@group(2) @binding(0) var shadow_map: texture_depth_2d;
@group(2) @binding(1) var shadow_sampler: sampler_comparison;

// Share of the key light that arrives, over a wide soft edge.
fn lit(world: vec3f, normal: vec3f, turn: f32) -> f32 {
    let radius = stage.eye.w;
    let p = stage.light * vec4f(world + normal * 0.02 * radius + stage.key.xyz * 0.01 * radius, 1.0);
    let uv = p.xy * vec2f(0.5, -0.5) + 0.5;
    // Vogel's spiral, turned by another angle in each pixel.
    var towards = vec2f(cos(turn), sin(turn)) * 0.018;
    var sum = 0.0;
    for (var k = 0; k < 8; k++) {
        let at = uv + sqrt((f32(k) + 0.5) / 8.0) * towards;
        sum += textureSampleCompareLevel(shadow_map, shadow_sampler, at, p.z);
        towards = vec2f(-0.7373688 * towards.x - 0.6754903 * towards.y, 0.6754903 * towards.x - 0.7373688 * towards.y);
    }
    return sum / 8.0;
}

// Shade in hollows:
// M. McGuire et al., The Alchemy screen-space ambient obscurance algorithm, HPG 2011.

fn depth_of(s: vec4f) -> f32 {
    return s.x + s.y / 255.0;
}

fn place(pixel: vec2f, depth: f32) -> vec3f {
    let z = mix(stage.right.w, stage.up.w, depth);
    let aside = (pixel * 2.0 - stage.window.zw) / stage.back.w;
    return vec3f(aside.x * z, -aside.y * z, -z);
}

@fragment
fn hollow(in: Screen) -> @location(0) vec4f {
    let size = vec2i(textureDimensions(source));
    let here = textureLoad(source, vec2i(in.position.xy), 0);
    if here.x > 0.9999 {
        return vec4f(1.0);
    }
    let p = place(in.position.xy, depth_of(here));
    let world = unpack_direction(here.zw * 2.0 - 1.0);
    let n = vec3f(dot(world, stage.right.xyz), dot(world, stage.up.xyz), dot(world, stage.back.xyz));
    let reach = 0.16 * stage.eye.w;
    let pixels = 0.5 * reach * stage.back.w / -p.z;
    let turn = noise(floor(in.position.xy)) * 6.2831853;
    var towards = vec2f(cos(turn), sin(turn)) * pixels;
    var sum = 0.0;
    for (var k = 0; k < 10; k++) {
        // Three turns of a spiral.
        let at = vec2i(in.position.xy + (f32(k) + 0.5) / 10.0 * towards);
        towards = vec2f(-0.309017 * towards.x - 0.9510565 * towards.y, 0.9510565 * towards.x - 0.309017 * towards.y);
        let other = textureLoad(source, clamp(at, vec2i(0), size - 1), 0);
        if other.x < 0.9999 {
            let v = place(vec2f(at) + 0.5, depth_of(other)) - p;
            let d2 = dot(v, v);
            let fade = max(1.0 - d2 / (reach * reach), 0.0);
            sum += fade * fade * max(dot(v, n) * inverseSqrt(d2 + 1e-12) - 0.12, 0.0);
        }
    }
    let open = clamp(1.0 - 2.6 * sum / 10.0, 0.0, 1.0);
    let from_eye = stage.right.xyz * p.x + stage.up.xyz * p.y + stage.back.xyz * p.z;
    return vec4f(open, here.x, here.y, lit(stage.eye.xyz + from_eye, world, turn));
}

@fragment
fn hollow_blur(in: Screen) -> @location(0) vec4f {
    let size = vec2i(textureDimensions(source));
    let at = vec2i(in.position.xy);
    let here = textureLoad(source, at, 0);
    if here.y > 0.9999 {
        return here;
    }
    let depth = here.y + here.z / 255.0;
    var sum = vec2f(0.0);
    var weight = 0.0;
    for (var y = -2; y <= 2; y++) {
        for (var x = -2; x <= 2; x++) {
            let s = textureLoad(source, clamp(at + vec2i(x, y), vec2i(0), size - 1), 0);
            let d = (s.y + s.z / 255.0 - depth) * 40.0;
            let w = exp(-d * d);
            sum += w * s.xw;
            weight += w;
        }
    }
    let light = sum / weight;
    return vec4f(light.x, here.y, here.z, light.y);
}
