//! Bilinear upsampling and argmax, fused.
