// Metres of water towards the light are added up; of the depths the smallest stays.
uniform float radius;
uniform float filling;  // volume of a particle over that of its sphere
uniform float depth_range;  // m
in vec2 corner;
out vec4 water;

void main() {
    float squared = dot(corner, corner);
    if (squared > 1.0) discard;
    float bulge = radius * sqrt(1.0 - squared);
    water = vec4(vec3(2.0 * filling * bulge), gl_FragCoord.z - bulge / depth_range);
}
