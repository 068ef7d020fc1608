/** Which backends of the graphics to try. */

/** The backends worth trying. WebGPU is probed without a canvas: one that fails would be spoilt for WebGL2. */
export async function backends(forced) {
  if (forced) return [forced];
  const adapter = await navigator.gpu?.requestAdapter().catch(() => null);
  return adapter ? ['webgpu', 'webgl2'] : ['webgl2'];
}
