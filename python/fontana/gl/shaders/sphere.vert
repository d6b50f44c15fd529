// A square that covers the sphere of a particle, wherever it is in the picture.
uniform mat4 view, projection;
uniform float radius;        // m
uniform vec2 value_range;
uniform float shutter_time;   // s, from the time of the frame
uniform float size_by_crowd;  // 1: drops that fly alone are drawn at their own size, not at that of a crowd
uniform float free_fall;     // m/s, a speed that fits the size of the stage
in vec2 in_corner;
in vec3 in_position;
in vec3 in_velocity;
in float in_value;
in vec2 in_state;  // density over rest density; speed (m/s)
out vec3 view_centre;
out vec3 on_square;
out float shown_radius;
out float value;
out float body;   // 1 in the body of the water, 0 for a drop alone
out float spray;  // 0 in the body of the water, 1 for a fast drop alone

void main() {
    body = smoothstep(0.34, 0.74, in_state.x);
    shown_radius = radius * mix(1.0, mix(0.4, 1.0, body), size_by_crowd);
    view_centre = (view * vec4(in_position + shutter_time * in_velocity, 1.0)).xyz;
    value = (in_value - value_range.x) / (value_range.y - value_range.x);
    spray = (1.0 - smoothstep(0.45, 0.80, in_state.x)) * smoothstep(0.05, 0.33, in_state.y / free_fall);
    // The silhouette of a sphere near the camera is wider than its radius: the square stands where the tangents meet it.
    float away = max(length(view_centre), 1.01 * shown_radius);
    float reach = shown_radius * away / sqrt(away * away - shown_radius * shown_radius);
    vec3 toward = -view_centre / away;
    vec3 right = normalize(cross(abs(toward.y) < 0.99 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), toward));
    vec3 up = cross(toward, right);
    on_square = view_centre + reach * (in_corner.x * right + in_corner.y * up);
    gl_Position = projection * vec4(on_square, 1.0);
}
