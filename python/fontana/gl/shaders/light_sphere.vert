// Discs that face the light.
uniform mat4 light_matrix;  // world to clip space
uniform vec3 light_right, light_up;
uniform float radius, shutter_time;
in vec2 in_corner;
in vec3 in_position;
in vec3 in_velocity;
out vec2 corner;

void main() {
    corner = in_corner;
    vec3 middle = in_position + shutter_time * in_velocity;
    vec3 place = middle + radius * (in_corner.x * light_right + in_corner.y * light_up);
    gl_Position = light_matrix * vec4(place, 1.0);
}
