#include "environment.glsl"
#include "screen.glsl"
in vec2 uv;
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth;

void main() {
    colour = vec4(surroundings(world_direction(uv)), 1.0);
    depth = 1e6;
}
