// Discs that face the light.
uniform mat4 light_matrix;  // world to clip space
uniform vec3 light_right, light_up;
uniform float radius;
in vec2 in_corner;
in vec3 in_position;
out vec2 corner;

void main() {
    corner = in_corner;
    vec3 place = in_position + radius * (in_corner.x * light_right + in_corner.y * light_up);
    gl_Position = light_matrix * vec4(place, 1.0);
}
