// Passes from picture to picture: the blur of the ground map, the shade in hollows and its blur.

@group(1) @binding(0) var source: texture_2d<f32>;

// --- ground map: three Gaussians in one, the wider the farther above the ground the shadow was thrown

fn spread(at: vec2i, along: vec2i) -> vec4f {
    let size = vec2i(textureDimensions(source));
    var sum = vec4f(0.0);
    var weight = vec4f(0.0);
    for (var k = -20; k <= 20; k++) {
        let x = f32(k);
        let w = exp(-x * x / (2.0 * vec4f(2.0, 26.0, 110.0, 1.0)));
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

// --- shade in hollows, at half the resolution
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
    var sum = 0.0;
    for (var k = 0; k < 10; k++) {
        let share = (f32(k) + 0.5) / 10.0;
        let angle = turn + share * 18.849556;
        let at = vec2i(in.position.xy + share * pixels * vec2f(cos(angle), sin(angle)));
        let other = textureLoad(source, clamp(at, vec2i(0), size - 1), 0);
        if other.x < 0.9999 {
            let v = place(vec2f(at) + 0.5, depth_of(other)) - p;
            let d2 = dot(v, v);
            let fade = max(1.0 - d2 / (reach * reach), 0.0);
            sum += fade * fade * max(dot(v, n) * inverseSqrt(d2 + 1e-12) - 0.12, 0.0);
        }
    }
    let open = clamp(1.0 - 2.6 * sum / 10.0, 0.0, 1.0);
    return vec4f(open, here.x, here.y, 1.0);
}

@fragment
fn hollow_blur(in: Screen) -> @location(0) vec4f {
    let size = vec2i(textureDimensions(source));
    let at = vec2i(in.position.xy);
    let here = textureLoad(source, at, 0);
    let depth = here.y + here.z / 255.0;
    var sum = 0.0;
    var weight = 0.0;
    for (var y = -2; y <= 2; y++) {
        for (var x = -2; x <= 2; x++) {
            let s = textureLoad(source, clamp(at + vec2i(x, y), vec2i(0), size - 1), 0);
            let d = (s.y + s.z / 255.0 - depth) * 40.0;
            let w = exp(-d * d);
            sum += w * s.x;
            weight += w;
        }
    }
    return vec4f(sum / weight, here.y, here.z, 1.0);
}
