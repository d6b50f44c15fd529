// One axis of the narrow-range filter: Truong & Yuksel, "A Narrow-Range Filter for Screen-Space Fluid Rendering",
// Proc. ACM Comput. Graph. Interact. Tech. 1(1), 2018.
//
// A Gaussian over depths. What lies nearer than the range belongs to another piece of water and is left out together
// with its mirror image, so that a slope is not pulled to one side; what lies farther counts as just behind, so that
// edges become round. The range follows the depths it has taken in, so that steep water stays one piece.
#define STEPS 18
uniform sampler2D fluid_depth;
uniform ivec2 axis;
uniform float filter_radius;     // m
uniform float pixels_per_metre;  // at a depth of 1 m
uniform float range_width;       // m
uniform float behind;            // m
layout(location = 0) out float smoothed;

const float NOTHING = 1e5;

float depth_at(ivec2 at) { return texelFetch(fluid_depth, clamp(at, ivec2(0), textureSize(fluid_depth, 0) - 1), 0).r; }

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    float middle = depth_at(here);
    smoothed = middle;
    if (middle > NOTHING) return;
    float reach = clamp(filter_radius * pixels_per_metre / middle, 1.0, 120.0);
    int count = min(STEPS, int(ceil(reach)));
    float stride = reach / float(count);
    float nearest = middle - range_width, farthest = middle + range_width;
    float low = nearest, high = farthest;
    float sum = middle, weights = 1.0;
    for (int k = 1; k <= count; ++k) {
        ivec2 away = axis * int(round(float(k) * stride));
        vec2 pair = vec2(depth_at(here + away), depth_at(here - away));
        if (min(pair.x, pair.y) < low) continue;
        float weight = exp(-4.5 * float(k * k) / float(count * count));
        vec2 kept = mix(pair, vec2(middle + behind), greaterThan(pair, vec2(high)));
        sum += weight * (kept.x + kept.y);
        weights += 2.0 * weight;
        if (pair.x <= high) { low = min(low, pair.x - range_width); high = max(high, pair.x + range_width); }
        if (pair.y <= high) { low = min(low, pair.y - range_width); high = max(high, pair.y + range_width); }
    }
    smoothed = sum / weights;
}
