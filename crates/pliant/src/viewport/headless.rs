//! A device without a window, and what to do when a device misbehaves.

use std::sync::{Arc, Mutex};

/// What can go wrong on the way to a picture. Each message says what to do.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// No driver offers a device. The command line answers with exit code 3.
    #[error(
        "no graphics adapter: {tried}. Install a driver; on Debian and Ubuntu `apt-get install mesa-vulkan-drivers` brings one that \
         needs no graphics card. `pliant deform` and `pliant info` work on the command line without one"
    )]
    NoAdapter {
        /// What was asked for and the answers.
        tried: String,
    },
    /// The picture was drawn but could not be read.
    #[error(
        "the picture could not be read back from the graphics device: {reason}. Try a smaller size or update the driver"
    )]
    Unreadable {
        /// What the device said.
        reason: String,
    },
}

/// A device without a window: any adapter, the software one included.
pub struct Headless {
    /// Makes resources.
    pub device: wgpu::Device,
    /// Takes work.
    pub queue: wgpu::Queue,
    /// Draws on the processor: fewer samples are wise.
    pub is_software: bool,
    watch: DeviceWatch,
}

impl Headless {
    /// Finds an adapter: Vulkan, Metal or Direct3D, then GL, then whatever draws in software.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] when none of them gives a device.
    pub fn new() -> Result<Headless, GpuError> {
        let attempts = [
            ("Vulkan, Metal or Direct3D", wgpu::Backends::PRIMARY, false),
            ("GL", wgpu::Backends::GL, false),
            ("software", wgpu::Backends::all(), true),
        ];
        let mut tried = Vec::new();
        for (name, backends, in_software) in attempts {
            match pollster::block_on(open(backends, in_software, None)) {
                Ok(headless) => return Ok(headless),
                Err(reason) => tried.push(format!("{name}: {reason}")),
            }
        }
        Err(GpuError::NoAdapter { tried: tried.join("; ") })
    }

    /// A device that can do less than the adapter, to test how the renderer gets by.
    #[cfg(test)]
    pub(super) fn with_limits(limits: wgpu::Limits) -> Result<Headless, String> {
        pollster::block_on(open(wgpu::Backends::all(), false, Some(limits)))
    }

    /// What the device complained about since the last call.
    pub fn take_error(&self) -> Option<String> {
        self.watch.take_error()
    }

    /// Why the device was lost, if it was.
    pub fn lost(&self) -> Option<String> {
        self.watch.lost()
    }
}

/// A device of one kind of adapter, with everything that adapter can do. The reason in one line otherwise.
/// `limits` asks for a lesser device.
async fn open(backends: wgpu::Backends, in_software: bool, limits: Option<wgpu::Limits>) -> Result<Headless, String> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let options = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        force_fallback_adapter: in_software,
        ..Default::default()
    };
    let adapter = instance.request_adapter(&options).await.map_err(|error| one_line(&error))?;
    let info = adapter.get_info();
    let descriptor = wgpu::DeviceDescriptor {
        label: Some("pliant"),
        required_limits: limits.unwrap_or_else(|| adapter.limits()),
        ..Default::default()
    };
    let (device, queue) = adapter
        .request_device(&descriptor)
        .await
        .map_err(|error| format!("{} refused: {}", info.name, one_line(&error)))?;
    log::info!("drawing on {} ({:?})", info.name, info.backend);
    let watch = watch_device(&device);
    Ok(Headless { device, queue, is_software: info.device_type == wgpu::DeviceType::Cpu, watch })
}

fn one_line(error: &dyn std::error::Error) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What happened to a device since [`watch_device`]. Clones see the same device.
#[derive(Clone, Debug, Default)]
pub struct DeviceWatch(Arc<Mutex<Seen>>);

#[derive(Debug, Default)]
struct Seen {
    lost: Option<String>,
    last_error: Option<String>,
}

impl DeviceWatch {
    /// Why the device was lost, if it was: nothing can be drawn with it any more, save what matters.
    pub fn lost(&self) -> Option<String> {
        self.note(|seen| seen.lost.clone())
    }

    /// The last complaint of the device since the last call, already logged.
    pub fn take_error(&self) -> Option<String> {
        self.note(|seen| seen.last_error.take())
    }

    /// The guarded notes; a panic elsewhere while holding them does not spoil them.
    fn note<T>(&self, read_or_write: impl FnOnce(&mut Seen) -> T) -> T {
        read_or_write(&mut self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner))
    }
}

/// Replaces wgpu's default answer to errors, a panic, by a log line and a note in the returned watch; likewise for loss of the device.
pub fn watch_device(device: &wgpu::Device) -> DeviceWatch {
    let watch = DeviceWatch::default();
    let on_error = watch.clone();
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        let text = one_line(&error);
        log::error!("graphics: {text}");
        on_error.note(|seen| seen.last_error = Some(text));
    }));
    let on_loss = watch.clone();
    device.set_device_lost_callback(move |reason, text| {
        // Our own end of the device also arrives here and is no loss.
        if reason != wgpu::DeviceLostReason::Destroyed {
            log::error!("graphics device lost: {text}");
            on_loss.note(|seen| seen.lost = Some(text));
        }
    });
    watch
}
