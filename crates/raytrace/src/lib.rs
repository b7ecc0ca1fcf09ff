//! Occlusion and closest hits in a triangle soup.
