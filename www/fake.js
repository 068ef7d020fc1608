/** TEMPORARY stand-in until the engine answers. Never to be released. */
const S = { source: null, target: null };
export const keepSource = (r) => (S.source = r, r);
export const keepTarget = (r) => (S.target = r, r);
const clone = (r) => ({ ...r, reference: r.reference.slice(), poses: r.poses.slice(), faces: r.faces.slice(), times: r.times });
const d2 = (a, i, b, j) => (a[3*i]-b[3*j])**2 + (a[3*i+1]-b[3*j+1])**2 + (a[3*i+2]-b[3*j+2])**2;
export const note = (which) => (r) => { S[which] = clone(r); return r; };
function far(ref, n) { const N = ref.length/3; const d = new Float64Array(N).fill(Infinity); const out = []; let next = 0;
  for (let k = 0; k < n; k++) { out.push(next); let best = -1; for (let v = 0; v < N; v++) { d[v] = Math.min(d[v], d2(ref, v, ref, next)); if (d[v] > best) { best = d[v]; next = v; } } } return out; }
function weights(ref, pts) { const N = ref.length/3, H = pts.length; const w = new Float32Array(N*H);
  for (let v = 0; v < N; v++) { let s = 0; for (let h = 0; h < H; h++) { const x = 1/(1e-6 + d2(ref, v, ref, pts[h])**2); w[v*H+h] = x; s += x; } for (let h = 0; h < H; h++) w[v*H+h] /= s; } return w; }
const groups = (w, H) => Uint32Array.from({ length: w.length/H }, (_, v) => { let b = 0; for (let h = 1; h < H; h++) if (w[v*H+h] > w[v*H+b]) b = h; return b; });
const energies = () => Array.from({ length: 6 }, (_, i) => Float64Array.from({ length: 9 }, (_, k) => 0.2 + Math.exp(-k*(0.4+0.1*i))));
export const operations = {
  keypoints: ({ parameters }, progress) => { const n = parameters.points ?? 12; const t = performance.now();
    while (performance.now() - t < 1500) { progress('choosing points', (performance.now()-t)/1500); }
    const key_points = far(S.source.reference, n); const candidates = Uint32Array.from(far(S.source.reference, 100));
    const w = weights(S.source.reference, key_points); const errors = key_points.map((_, i) => 0.15/(i+1));
    const steps = key_points.map((p, i) => ({ candidates: candidates.slice(i, 60), errors: Float32Array.from(candidates.slice(i, 60), (c) => errors[i]*(1+Math.random())), chosen: candidates[i] }));
    return { key_points: Uint32Array.from(key_points), errors, candidates, steps, groups: groups(w, n), weights: w, energies: energies(), warnings: [], seconds: [['all', 1.5]] }; },
  fit: ({ points }) => { const w = weights(S.source.reference, points); return { weights: w, groups: groups(w, points.length), error: 0.15/points.length, energies: energies() }; },
  drop_target: () => { S.target = null; }, 
  landmarks: () => ({ source: Uint32Array.from([1, 500, 900]), target: Uint32Array.from([1, 500, 900]) }),
  propose: ({ points, known }) => { const box = (r) => { const lo=[1e9,1e9,1e9], hi=[-1e9,-1e9,-1e9]; r.forEach((x,i)=>{lo[i%3]=Math.min(lo[i%3],x);hi[i%3]=Math.max(hi[i%3],x);}); return [lo,hi]; };
    const A = S.source.reference, B = S.target.reference, [l,h]=box(A),[L,H]=box(B);
    const out = points.map((p, i) => { if (known[i] != null) return { target: known[i], confidence: 1 }; const q=[0,1,2].map(k=>L[k]+(A[3*p+k]-l[k])/(h[k]-l[k])*(H[k]-L[k])); let b=0,bd=Infinity; for (let v=0;v<B.length/3;v++){const d=d2(B,v,q,0); if(d<bd){bd=d;b=v;}} return { target: b, confidence: 0.7 }; });
    return { points: out, next: known.findIndex((k) => k == null) }; },
  transfer: ({ pairs }) => { const t0=performance.now(); const H = pairs.length, K = Math.min(8, H), B = S.target.reference, A = S.source; const w = weights(B, pairs.map((p) => p.target)); const N = B.length/3;
    const indices = new Uint16Array(N*K), ws = new Float32Array(N*K);
    for (let v = 0; v < N; v++) { const o = [...Array(H).keys()].sort((a, b) => w[v*H+b]-w[v*H+a]).slice(0, K); let s = 0; o.forEach((h) => s += w[v*H+h]); o.forEach((h, k) => { indices[v*K+k] = h; ws[v*K+k] = w[v*H+h]/s; }); }
    const T = A.poses.length/A.reference.length; const m = new Float32Array(T*H*12);
    for (let t = 0; t < T; t++) pairs.forEach((p, h) => { const o = (t*H+h)*12; m[o]=m[o+5]=m[o+10]=1; for (let k=0;k<3;k++) m[o+4*k+3] = A.poses[t*A.reference.length+3*p.source+k]-A.reference[3*p.source+k]; });
    return { handles: H, sources: pairs.map((p) => p.source), indices, weights: ws, K, matrices: m, warnings: [], seconds: [['all', (performance.now()-t0)/1000]] }; },
  export_transfer: ({ form }) => ({ bytes: new Uint8Array(form === 'exact' ? 3e6 : 2e5), error: form === 'exact' ? 0 : 0.0012 }),
};
