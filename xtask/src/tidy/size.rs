//! The size of what git keeps: a clone must stay quick.

/// Bytes above which a file does not belong into the repository.
const MAX_BYTES: u64 = 256 * 1024;

/// What is wrong with a file of `bytes` bytes at `path`, if anything is.
pub(super) fn fault(path: &str, bytes: u64) -> Option<String> {
    (bytes > MAX_BYTES).then(|| format!("{path}: {} KiB; at most {} are kept in git", bytes / 1024, MAX_BYTES / 1024))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn size_can_fail() {
        assert_eq!(fault("Cargo.lock", MAX_BYTES), None);
        assert!(fault("docs/a.png", MAX_BYTES + 1).is_some_and(|fault| fault.contains("docs/a.png")));
    }
}
