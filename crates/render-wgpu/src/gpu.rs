//! The graphics device: found, opened, and asked what it can hold.

use crate::Error;

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
}

impl Gpu {
    /// Opens a device through Vulkan, Metal or DirectX 12, and through OpenGL where none of them answers.
    ///
    /// The variable `WGPU_BACKEND` (`vulkan`, `gl`, ...) narrows the choice.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] where no driver is installed, [`Error::NoDevice`] where it fails to start.
    pub fn new(driver: Driver) -> Result<Self, Error> {
        let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        // Only the look for an OpenGL driver writes to the console of its own accord, so it comes last.
        let gl = descriptor.backends & wgpu::Backends::GL;
        let others = descriptor.backends - wgpu::Backends::GL;
        let adapter = match adapter(others, driver) {
            Err(_) if !gl.is_empty() => adapter(gl, driver),
            found => found,
        };
        Self::open(&adapter?)
    }

    fn open(adapter: &wgpu::Adapter) -> Result<Self, Error> {
        let info = adapter.get_info();
        let features = adapter.features() & wgpu::Features::FLOAT32_BLENDABLE;
        // What the adapter has, not the portable minimum: large scenes should fit where they can.
        let limits = adapter.limits();
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("relume"),
            required_features: features,
            required_limits: limits.clone(),
            memory_hints: wgpu::MemoryHints::Performance,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| Error::NoDevice { adapter: info.name.clone(), reason: one_line(&error.to_string()) })?;
        let description = format!("{} ({})", info.name, info.backend);
        let float32 = adapter.get_texture_format_features(wgpu::TextureFormat::Rgba32Float);
        let draws_float32 = float32.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
        let blends_float32 = draws_float32 && features.contains(wgpu::Features::FLOAT32_BLENDABLE);
        let software = info.device_type == wgpu::DeviceType::Cpu;
        Ok(Self { device, queue, limits, draws_float32, blends_float32, description, software })
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
    pub(crate) fn guarded<T>(&self, doing: &'static str, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
        let filters = [wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Internal];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let result = work();
        let complaints = scopes.into_iter().rev().map(|scope| pollster::block_on(scope.pop()));
        // All scopes are popped before any complaint is looked at.
        let complaint = complaints.collect::<Vec<_>>().into_iter().flatten().next();
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
fn adapter(backends: wgpu::Backends, driver: Driver) -> Result<wgpu::Adapter, Error> {
    let descriptor =
        wgpu::InstanceDescriptor { backends, ..wgpu::InstanceDescriptor::new_without_display_handle_from_env() };
    let options = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        force_fallback_adapter: driver == Driver::Software,
        ..Default::default()
    };
    pollster::block_on(wgpu::Instance::new(descriptor).request_adapter(&options))
        .map_err(|error| Error::NoAdapter { reason: one_line(&error.to_string()) })
}

/// Error texts of wgpu run over many lines; a sentence has one.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
