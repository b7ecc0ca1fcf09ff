//! One transfer vector per receiver, laid out for the sums of the bounces.

/// Channels are padded to a multiple of this, so that sums run in whole blocks.
pub(crate) const BLOCK: usize = 4;

/// `[receiver][channel][coefficient, padded]`.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    pub(crate) coefficients: usize,
    pub(crate) channels: usize,
    stride: usize,
    values: Vec<f32>,
}

impl Field {
    pub(crate) fn zeros(receivers: usize, coefficients: usize, channels: usize) -> Self {
        let stride = coefficients.next_multiple_of(BLOCK);
        Self { coefficients, channels, stride, values: vec![0.0; receivers * channels * stride] }
    }

    /// Bytes of a field.
    pub(crate) fn bytes(receivers: usize, coefficients: usize, channels: usize) -> u64 {
        (receivers * channels * coefficients.next_multiple_of(BLOCK) * 4) as u64
    }

    /// Adds receivers with zeros at the end.
    pub(crate) fn grow(&mut self, receivers: usize) {
        self.values.resize(receivers * self.row_len(), 0.0);
    }

    /// Values per receiver.
    pub(crate) fn row_len(&self) -> usize {
        self.channels * self.stride
    }

    /// All channels of one receiver.
    pub(crate) fn row(&self, receiver: u32) -> &[f32] {
        let n = self.row_len();
        &self.values[receiver as usize * n..][..n]
    }

    pub(crate) fn row_mut(&mut self, receiver: u32) -> &mut [f32] {
        let n = self.row_len();
        &mut self.values[receiver as usize * n..][..n]
    }

    /// One channel of one receiver.
    pub(crate) fn channel(&self, receiver: u32, channel: usize) -> &[f32] {
        &self.row(receiver)[channel * self.stride..][..self.coefficients]
    }

    /// Sets a receiver to `[channel][coefficient]`, or where that is empty every channel to the same coefficients.
    pub(crate) fn set_direct(&mut self, receiver: u32, all: &[f32], tinted: &[f32]) {
        if tinted.is_empty() { self.set_all(receiver, all) } else { self.set(receiver, tinted) }
    }

    /// Sets every channel of a receiver to the same coefficients.
    pub(crate) fn set_all(&mut self, receiver: u32, coefficients: &[f32]) {
        let stride = self.stride;
        for channel in self.row_mut(receiver).chunks_exact_mut(stride) {
            channel[..coefficients.len()].copy_from_slice(coefficients);
        }
    }

    /// Number of receivers.
    pub(crate) fn len(&self) -> usize {
        self.values.len() / self.row_len().max(1)
    }

    /// Sets a receiver to `[channel][coefficient]`, of which further channels are left out.
    pub(crate) fn set(&mut self, receiver: u32, values: &[f32]) {
        let (stride, coefficients) = (self.stride, self.coefficients);
        for (channel, own) in self.row_mut(receiver).chunks_exact_mut(stride).zip(values.chunks_exact(coefficients)) {
            channel[..coefficients].copy_from_slice(own);
        }
    }

    /// Adds another field of the same shape.
    pub(crate) fn add(&mut self, other: &Self) {
        for (a, b) in self.values.iter_mut().zip(&other.values) {
            *a += b;
        }
    }

    /// This field without another of the same shape.
    pub(crate) fn without(&self, other: &Self) -> Self {
        let values = self.values.iter().zip(&other.values).map(|(a, b)| a - b).collect();
        Self { values, ..*self }
    }

    /// Over all receivers, for one channel: the products of this field with itself, of this with another, and of that with itself.
    pub(crate) fn products(&self, other: &Self, channel: usize) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for receiver in 0..self.len() as u32 {
            let pairs = self.channel(receiver, channel).iter().zip(other.channel(receiver, channel));
            for (a, b) in pairs.map(|(a, b)| (f64::from(*a), f64::from(*b))) {
                sums = [sums[0] + a * a, sums[1] + a * b, sums[2] + b * b];
            }
        }
        sums
    }

    /// The sum of this field and another of the same shape with the factors of each channel.
    pub(crate) fn combined(&self, other: &Self, factors: &dyn Fn(usize) -> [f32; 2]) -> Self {
        let mut out = self.clone();
        let stride = self.stride;
        for receiver in 0..self.len() as u32 {
            let rows = out.row_mut(receiver).chunks_exact_mut(stride).zip(other.row(receiver).chunks_exact(stride));
            for (c, (own, other)) in rows.enumerate() {
                let [a, b] = factors(c);
                own.iter_mut().zip(other).for_each(|(x, y)| *x = a * *x + b * y);
            }
        }
        out
    }

    /// Largest norm over the channels of a receiver.
    pub(crate) fn norm(&self, receiver: u32) -> f64 {
        let square = |c: &[f32]| c.iter().map(|&x| f64::from(x) * f64::from(x)).sum::<f64>();
        self.row(receiver).chunks_exact(self.stride).map(square).fold(0.0, f64::max).sqrt()
    }
}
