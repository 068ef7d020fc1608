//! Drawing: camera, palettes, picking (plain), and the GPU scene (in the page bundle only).
