// A skin: each drawn vertex is taken where the mixed maps of its handles take it. The target is a texture of the same
// kind as the shapes, so that everything else is drawn as if there were no skin.

@group(1) @binding(0) var reference: texture_2d<u32>;   // a drawn vertex's position (bits) and packed normal
@group(1) @binding(1) var follows: texture_2d<u32>;     // four handles and weights a texel; as many blocks as it takes
@group(1) @binding(2) var maps: texture_2d<f32>;        // three rows of each handle's map

fn map_row(i: u32) -> vec4f {
    return textureLoad(maps, vec2u(i & 2047u, i >> 11u), 0);
}

// Packs a direction as normals.rs does.
fn pack_direction(direction: vec3f) -> u32 {
    let sum = dot(abs(direction), vec3f(1.0));
    let n = select(vec3f(0.0, 1.0, 0.0), direction / sum, sum > 0.0);
    let turned = (1.0 - abs(n.yx)) * select(vec2f(-1.0), vec2f(1.0), n.xy >= vec2f(0.0));
    return pack2x16snorm(select(turned, n.xy, n.z >= 0.0));
}

@vertex
fn everywhere(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32((i << 1u) & 2u), f32(i & 2u)) * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), 0.0, 1.0);
}

@fragment
fn skinned(@builtin(position) position: vec4f) -> @location(0) vec4u {
    let at = vec2u(position.xy);
    let rows = textureDimensions(reference).y;
    let blocks = textureDimensions(follows).y / rows;
    let here = textureLoad(reference, at, 0);
    var x = vec4f(0.0);
    var y = vec4f(0.0);
    var z = vec4f(0.0);
    for (var block = 0u; block < blocks; block++) {
        let four = textureLoad(follows, at + vec2u(0u, block * rows), 0);
        for (var k = 0; k < 4; k++) {
            let weight = f32(four[k] >> 16u) / 65535.0;
            if weight > 0.0 {
                let first = (four[k] & 65535u) * 3u;
                x += weight * map_row(first);
                y += weight * map_row(first + 1u);
                z += weight * map_row(first + 2u);
            }
        }
    }
    let p = vec4f(bitcast<vec3f>(here.xyz), 1.0);
    // Area vectors turn with the cofactors, also where the map flattens or mirrors.
    let n = unpack_direction(unpack2x16snorm(here.w));
    let turned = vec3f(dot(cross(y.xyz, z.xyz), n), dot(cross(z.xyz, x.xyz), n), dot(cross(x.xyz, y.xyz), n));
    return vec4u(bitcast<vec3u>(vec3f(dot(x, p), dot(y, p), dot(z, p))), pack_direction(turned));
}
