//! The graphics device: found, opened, and asked what it can hold.

use crate::Error;
use std::sync::{Arc, OnceLock};

/// Which adapters may be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Driver {
    /// The fastest that the machine has; a software driver where there is no GPU.
    #[default]
    Any,
    /// Only a software driver: the same picture on every machine, for tests.
    Software,
}

/// An open device without any window. Cheap to clone: clones share the device.
#[derive(Debug, Clone)]
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) limits: wgpu::Limits,
    /// Drawing into 32-bit float pictures; without it (OpenGL) all pictures are of 16-bit floats.
    pub(crate) draws_float32: bool,
    /// Blending into them; without it blended scenes are drawn in 16-bit floats.
    pub(crate) blends_float32: bool,
    description: String,
    software: bool,
    /// Why the device was lost, once it is.
    lost: Arc<OnceLock<String>>,
}

impl Gpu {
    /// Draws on a device that the caller has opened, of the wgpu that this crate re-exports.
    ///
    /// The device needs nothing beyond the limits of WebGPU. Its callbacks stay the caller's: call
    /// [`Gpu::report_lost`] from
    /// the one for lost devices. `FLOAT32_BLENDABLE` makes transparent surfaces exact.
    ///
    /// # Errors
    /// [`Error::TooLarge`] for a device with fewer bind groups, vertex buffers or storage buffers than WebGPU promises.
    pub fn from_wgpu(device: wgpu::Device, queue: wgpu::Queue) -> Result<Self, Error> {
        let (limits, info) = (device.limits(), device.adapter_info());
        let open = "open the device with the default limits of wgpu";
        let needed = [
            (4, limits.max_bind_groups, "bind groups"),
            (8, limits.max_vertex_buffers, "vertex buffers"),
            (8, limits.max_storage_buffers_per_shader_stage, "storage buffers per shader"),
        ];
        for (needed, limit, unit) in needed {
            Error::check_fits(|| "drawing".into(), needed, u64::from(limit), unit, open)?;
        }
        // WebGPU promises 32-bit float targets; OpenGL does not, and only its adapter could tell.
        let draws_float32 = info.backend != wgpu::Backend::Gl;
        Ok(Self::with(device, queue, &info, draws_float32))
    }

    fn with(device: wgpu::Device, queue: wgpu::Queue, info: &wgpu::AdapterInfo, draws_float32: bool) -> Self {
        Self {
            limits: device.limits(),
            draws_float32,
            blends_float32: draws_float32 && device.features().contains(wgpu::Features::FLOAT32_BLENDABLE),
            description: format!("{} ({})", info.name, info.backend),
            software: info.device_type == wgpu::DeviceType::Cpu,
            lost: Arc::default(),
            device,
            queue,
        }
    }

    /// Tells this device and its clones that it is lost: frames fail with [`Error::DeviceLost`] from now on.
    pub fn report_lost(&self, reason: &str) {
        // The first reason stays.
        let _ = self.lost.set(one_line(reason));
    }

    /// Fails with [`Error::DeviceLost`] after [`Gpu::report_lost`].
    pub(crate) fn check_lost(&self) -> Result<(), Error> {
        self.lost.get().map_or(Ok(()), |reason| Err(Error::DeviceLost { reason: reason.clone() }))
    }

    /// Opens a device through Vulkan, Metal or DirectX 12, and through OpenGL where none of them answers.
    ///
    /// The variable `WGPU_BACKEND` (`vulkan`, `gl`, ...) narrows the choice.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] where no driver is installed, [`Error::NoDevice`] where it fails to start.
    pub fn new(driver: Driver) -> Result<Self, Error> {
        pollster::block_on(Self::new_async(driver))
    }

    /// [`Gpu::new`] to be awaited, as a browser has to.
    ///
    /// # Errors
    /// As [`Gpu::new`].
    pub async fn new_async(driver: Driver) -> Result<Self, Error> {
        let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        // Only the look for an OpenGL driver writes to the console of its own accord, so it comes last.
        let gl = descriptor.backends & wgpu::Backends::GL;
        let others = descriptor.backends - wgpu::Backends::GL;
        let adapter = match adapter(others, driver).await {
            Err(_) if !gl.is_empty() => adapter(gl, driver).await,
            found => found,
        };
        Self::open(&adapter?).await
    }

    async fn open(adapter: &wgpu::Adapter) -> Result<Self, Error> {
        let info = adapter.get_info();
        let features = adapter.features() & wgpu::Features::FLOAT32_BLENDABLE;
        // What the adapter has, not the portable minimum: large scenes should fit where they can.
        let limits = adapter.limits();
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("relume"),
            required_features: features,
            required_limits: limits,
            memory_hints: wgpu::MemoryHints::Performance,
            ..Default::default()
        };
        let (device, queue) = adapter
            .request_device(&descriptor)
            .await
            .map_err(|error| Error::NoDevice { adapter: info.name.clone(), reason: one_line(&error.to_string()) })?;
        let float32 = adapter.get_texture_format_features(wgpu::TextureFormat::Rgba32Float);
        let draws_float32 = float32.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
        let gpu = Self::with(device, queue, &info, draws_float32);
        let lost = Arc::clone(&gpu.lost);
        gpu.device.set_device_lost_callback(move |_, reason| drop(lost.set(one_line(&reason))));
        Ok(gpu)
    }

    /// The format of linear pictures: exact on both sides of the read-back where the adapter can draw it.
    pub(crate) fn linear(&self) -> wgpu::TextureFormat {
        if self.draws_float32 { wgpu::TextureFormat::Rgba32Float } else { wgpu::TextureFormat::Rgba16Float }
    }

    /// The format of samples, which scenes with transparent surfaces `blend`.
    pub(crate) fn samples(&self, blend: bool) -> wgpu::TextureFormat {
        if blend && !self.blends_float32 { wgpu::TextureFormat::Rgba16Float } else { self.linear() }
    }

    /// Name of the adapter and of the interface, for people.
    #[must_use]
    pub fn description(&self) -> &str {
        &self.description
    }

    /// Whether the processor does the work of a graphics device, through a software driver.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.software
    }

    /// Runs `work` and turns what the driver complains about into an [`Error::Gpu`].
    pub(crate) async fn guarded<T>(
        &self,
        doing: &'static str,
        work: impl FnOnce() -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.check_lost()?;
        let filters = [wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Internal];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let result = work();
        // All scopes are popped before any complaint is awaited: they belong to this thread.
        let complaints = scopes.into_iter().rev().map(wgpu::ErrorScopeGuard::pop).collect::<Vec<_>>();
        let mut complaint = None;
        for answer in complaints {
            let answer = answer.await;
            complaint = complaint.or(answer);
        }
        let value = result?;
        match complaint {
            Some(error) => Err(Error::Gpu { doing, reason: one_line(&error.to_string()) }),
            None => Ok(value),
        }
    }

    /// Waits until the device has done all that it was given.
    pub(crate) fn wait(&self) -> Result<(), Error> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map(drop)
            .map_err(|error| Error::Gpu { doing: "finishing a frame", reason: one_line(&error.to_string()) })
    }
}

/// The adapter of one of `backends`.
async fn adapter(backends: wgpu::Backends, driver: Driver) -> Result<wgpu::Adapter, Error> {
    let descriptor =
        wgpu::InstanceDescriptor { backends, ..wgpu::InstanceDescriptor::new_without_display_handle_from_env() };
    let options = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        force_fallback_adapter: driver == Driver::Software,
        ..Default::default()
    };
    wgpu::Instance::new(descriptor)
        .request_adapter(&options)
        .await
        .map_err(|error| Error::NoAdapter { reason: one_line(&error.to_string()) })
}

/// Error texts of wgpu run over many lines; a sentence has one.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
