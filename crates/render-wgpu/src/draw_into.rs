//! Frames in a caller's texture: recorded, handed over, not waited for.

use crate::target::Target;
use crate::{Error, Frame, Renderer};

impl Renderer {
    /// Draws one picture into the caller's `view`, whose format is `format`. It waits for nothing
    /// and reads nothing back.
    ///
    /// The frame is submitted to the queue, so work that is submitted later finds it in the
    /// texture. `Rgba8Unorm` and `Bgra8Unorm` receive
    /// sRGB values and their `Srgb` twins are encoded by the hardware. `Rgba16Float` and `Rgba32Float` receive linear
    /// radiance without tone curve. Alpha is 1. What the driver complains about goes to the device's own error handler.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a view whose format, usage or size does not fit the frame,
    /// [`Error::DeviceLost`] for a device
    /// that is known to be lost, and the errors of [`Renderer::draw`] that need no answer of the device.
    pub fn draw_into(
        &mut self,
        view: &wgpu::TextureView,
        format: wgpu::TextureFormat,
        frame: &Frame,
    ) -> Result<(), Error> {
        let basis = self.check(frame)?;
        let target = Target { view, format };
        target.check(frame)?;
        self.gpu().check_lost()?;
        let encoder = self.record(frame, basis, Some(target))?;
        self.gpu().queue.submit([encoder.finish()]);
        Ok(())
    }
}
