// One axis of the narrow-range filter: Truong & Yuksel, "A Narrow-Range Filter for Screen-Space Fluid Rendering",
// Proc. ACM Comput. Graph. Interact. Tech. 1(1), 2018.
//
// A Gaussian over depths. What lies nearer than the range belongs to another piece of water and is left out together
// with its mirror image, so that a slope is not pulled to one side; what lies farther counts as just behind, so that
// edges become round. The range follows the depths it has taken in, so that steep water stays one piece.
#define STEPS 16
uniform sampler2D fluid_depth;   // x: depth (m); y: how much of it is to be smoothed
uniform ivec2 axis;              // (0, 0): both at once, over few pixels, which removes the streaks of the two
uniform float filter_radius;     // m
uniform float pixels_per_metre;  // at a depth of 1 m
uniform float range_width;       // m
uniform float behind;            // m
layout(location = 0) out vec2 smoothed;

const float NOTHING = 1e5;

struct Range {
    float low, high;
};

float depth_at(ivec2 at) { return texelFetch(fluid_depth, clamp(at, ivec2(0), textureSize(fluid_depth, 0) - 1), 0).r; }

// Adds two depths on opposite sides to the sum, the weight to the weights.
void take_in(ivec2 here, ivec2 away, float weight, float middle, inout Range range, inout vec2 sum) {
    vec2 pair = vec2(depth_at(here + away), depth_at(here - away));
    if (min(pair.x, pair.y) < range.low) return;
    vec2 kept = mix(pair, vec2(middle + behind), greaterThan(pair, vec2(range.high)));
    sum += weight * vec2(kept.x + kept.y, 2.0);
    float nearest = min(kept.x, kept.y), farthest = max(kept.x, kept.y);
    range = Range(min(range.low, nearest - range_width), max(range.high, farthest + range_width));
}

float along_axis(ivec2 here, float middle, float reach) {
    int count = min(STEPS, int(ceil(reach)));
    vec2 sum = vec2(middle, 1.0);
    Range range = Range(middle - range_width, middle + range_width);
    for (int k = 1; k <= count; ++k) {
        float share = float(k) / float(count);
        take_in(here, axis * int(round(share * reach)), exp(-4.5 * share * share), middle, range, sum);
    }
    return sum.x / sum.y;
}

float around(ivec2 here, float middle, float reach) {
    int count = int(clamp(0.35 * reach, 0.0, 3.0));
    vec2 sum = vec2(middle, 1.0);
    for (int y = 0; y <= count; ++y) {
        for (int x = y == 0 ? 1 : -count; x <= count; ++x) {
            Range range = Range(middle - range_width, middle + range_width);
            take_in(here, ivec2(x, y), exp(-2.0 * float(x * x + y * y) / float(count * count)), middle, range, sum);
        }
    }
    return sum.x / sum.y;
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    smoothed = texelFetch(fluid_depth, here, 0).rg;
    if (smoothed.x > NOTHING) return;
    float reach = min(smoothed.y * filter_radius * pixels_per_metre / smoothed.x, 120.0);
    if (reach < 1.0) return;
    smoothed.x = axis == ivec2(0) ? around(here, smoothed.x, reach) : along_axis(here, smoothed.x, reach);
}
