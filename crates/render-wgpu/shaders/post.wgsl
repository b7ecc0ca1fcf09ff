// What turns the drawn samples into a picture. Mirrors `Post` in gpu_data.rs.
struct Post {
    // 2^EV.
    exposure: f32,
    // Samples along each side of a pixel.
    supersample: u32,
    // Strength of the bloom.
    bloom: f32,
    // Levels of the blur pyramid.
    levels: f32,
    // Most that the picture's format can hold.
    largest: f32,
}
