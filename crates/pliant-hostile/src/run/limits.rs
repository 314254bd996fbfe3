//! What a process may take.

/// Address space of a worker: more than it may ever fill.
pub const MEMORY_BYTES: u64 = 1 << 30;
/// Processor time that one file may take.
pub const CPU_SECONDS: u64 = 2;

/// Limits the memory of this process, and keeps its crashes off the disk.
#[cfg(unix)]
pub(super) fn limit_memory() {
    use rustix::process::{Resource, Rlimit, setrlimit};
    let exactly = |bytes| Rlimit { current: Some(bytes), maximum: Some(bytes) };
    // A system that has no such limit still runs the files.
    let _ = setrlimit(Resource::As, exactly(MEMORY_BYTES));
    let _ = setrlimit(Resource::Core, exactly(0));
}

/// Gives this process so much processor time from now on; it is ended when that is spent.
#[cfg(unix)]
pub(super) fn limit_time() {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    // Counted in whole seconds: up to one more than asked for.
    let current = Some(cpu_ms() / 1000 + CPU_SECONDS + 1);
    let _ = setrlimit(Resource::Cpu, Rlimit { current, ..getrlimit(Resource::Cpu) });
}

/// Processor time of this process so far.
#[cfg(unix)]
pub(super) fn cpu_ms() -> u64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as u64 * 1000 + time.tv_nsec as u64 / 1_000_000
}

#[cfg(not(unix))]
pub(super) fn limit_memory() {}

#[cfg(not(unix))]
pub(super) fn limit_time() {}

#[cfg(not(unix))]
pub(super) fn cpu_ms() -> u64 {
    0
}

/// The most memory this process has filled since it was last asked, in kilobytes; 0 where the system does not tell.
pub(super) fn peak_kb() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let peak = line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0);
    // Starts the measuring anew.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    peak
}
