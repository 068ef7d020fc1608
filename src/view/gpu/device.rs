//! The device and the surface that it draws to.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use wgpu::{
    Backends, CompositeAlphaMode, DeviceDescriptor, Instance, InstanceDescriptor, Limits, PresentMode,
    RequestAdapterOptions, SurfaceColorSpace, SurfaceConfiguration, SurfaceTarget, SurfaceTexture, TextureFormat,
    TextureUsages,
};

/// What draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// WebGPU.
    WebGpu,
    /// WebGL 2.
    WebGl2,
}

/// A device with the canvas that it draws to.
pub struct Gpu {
    /// Which kind it is.
    pub backend: Backend,
    /// Makes textures and pipelines.
    pub device: wgpu::Device,
    /// Takes work.
    pub queue: wgpu::Queue,
    /// Format of the canvas: never one that encodes sRGB by itself, because WebGPU canvases have none. The shaders
    /// encode, so both backends give the same brightness.
    pub format: TextureFormat,
    /// Longest side of a texture, pixels.
    pub longest: u32,
    surface: wgpu::Surface<'static>,
    size: (u32, u32),
    lost: Arc<AtomicBool>,
    under_way: Arc<AtomicUsize>,
}

impl Gpu {
    /// Opens a device for `canvas`. The error is a sentence.
    pub async fn open(canvas: web_sys::HtmlCanvasElement, backend: Backend) -> Result<Self, String> {
        let name = match backend {
            Backend::WebGpu => "WebGPU",
            Backend::WebGl2 => "WebGL 2",
        };
        let fail = |what: &str| [name, " cannot be used here: ", what, "."].concat();
        let mut descriptor = InstanceDescriptor::new_without_display_handle();
        descriptor.backends = match backend {
            Backend::WebGpu => Backends::BROWSER_WEBGPU,
            Backend::WebGl2 => Backends::GL,
        };
        let instance = Instance::new(descriptor);
        let surface = instance
            .create_surface(SurfaceTarget::Canvas(canvas))
            .map_err(|_| fail("the canvas gives no drawing context"))?;
        let options = RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = instance.request_adapter(&options).await.map_err(|_| fail("there is no graphics adapter"))?;
        let limits = Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits());
        let longest = limits.max_texture_dimension_2d;
        let (device, queue) = adapter
            .request_device(&DeviceDescriptor { required_limits: limits, ..Default::default() })
            .await
            .map_err(|_| fail("the graphics adapter gives no device"))?;
        let formats = surface.get_capabilities(&adapter).formats;
        let format = formats
            .into_iter()
            .find(|f| matches!(f, TextureFormat::Bgra8Unorm | TextureFormat::Rgba8Unorm))
            .ok_or_else(|| fail("the canvas has no usable format"))?;
        let lost = Arc::new(AtomicBool::new(false));
        let flag = lost.clone();
        device.set_device_lost_callback(move |_, _| flag.store(true, Ordering::Relaxed));
        let flag = lost.clone();
        // Without this an error would end the page's wasm for good.
        device.on_uncaptured_error(Arc::new(move |error| {
            crate::web::page::log(&error.to_string());
            if matches!(error, wgpu::Error::OutOfMemory { .. } | wgpu::Error::Internal { .. }) {
                flag.store(true, Ordering::Relaxed);
            }
        }));
        Ok(Self { backend, device, queue, format, longest, surface, size: (0, 0), lost, under_way: Arc::default() })
    }

    /// Whether the device is gone for good.
    pub fn lost(&self) -> bool {
        self.lost.load(Ordering::Relaxed)
    }

    /// Says that all that was submitted up to now makes a frame.
    pub fn submitted(&self) {
        self.under_way.fetch_add(1, Ordering::Relaxed);
        let count = self.under_way.clone();
        self.queue.on_submitted_work_done(move || {
            count.fetch_sub(1, Ordering::Relaxed);
        });
    }

    /// How many frames were submitted that are not drawn yet.
    pub fn under_way(&self) -> usize {
        // On WebGL 2 only this looks what has become of them.
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.under_way.load(Ordering::Relaxed)
    }

    /// Whether textures can hold a mesh with so many corners, even if each has a normal of its own.
    pub fn holds(&self, corners: usize) -> bool {
        corners.div_ceil(super::textures::WIDTH) <= self.longest as usize
    }

    /// Size of the picture, pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Sets the size of the picture, pixels; at least 1, at most what a texture can have.
    pub fn resize(&mut self, width: u32, height: u32) {
        self.size = (width.clamp(1, self.longest), height.clamp(1, self.longest));
        self.configure();
    }

    fn configure(&self) {
        let configuration = SurfaceConfiguration {
            usage: TextureUsages::RENDER_ATTACHMENT,
            format: self.format,
            color_space: SurfaceColorSpace::Auto,
            width: self.size.0,
            height: self.size.1,
            present_mode: PresentMode::Fifo,
            desired_maximum_frame_latency: 2,
            alpha_mode: CompositeAlphaMode::Opaque,
            view_formats: Vec::new(),
        };
        self.surface.configure(&self.device, &configuration);
    }

    /// The picture to draw next; `None` if there is none at the moment, or if the device is lost.
    pub fn picture(&self) -> Option<SurfaceTexture> {
        use wgpu::CurrentSurfaceTexture as Current;
        if self.lost() || self.size.0 == 0 {
            return None;
        }
        match self.surface.get_current_texture() {
            Current::Success(picture) | Current::Suboptimal(picture) => Some(picture),
            Current::Outdated => {
                self.configure();
                None
            }
            Current::Lost => {
                self.lost.store(true, Ordering::Relaxed);
                None
            }
            Current::Timeout | Current::Occluded | Current::Validation => None,
        }
    }
}
