// Half a level of noise either way keeps wide gradients from showing their steps.
float dither(vec2 pixel) { return (pixel_noise(pixel.yx) - 0.5) / 255.0; }
