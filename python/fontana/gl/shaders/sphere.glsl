// Where the ray of a pixel meets the sphere of a particle.
uniform mat4 projection;
in vec3 view_centre;
in vec3 on_square;
in float shown_radius;

// False beside the sphere. `chord` is how much of the ray lies within (m).
bool meet_sphere(out vec3 hit, out float chord) {
    vec3 ray = normalize(on_square);
    float middle = dot(ray, view_centre);
    vec3 beside = view_centre - middle * ray;
    float inside = shown_radius * shown_radius - dot(beside, beside);
    if (inside <= 0.0 || middle <= 0.0) return false;
    chord = 2.0 * sqrt(inside);
    hit = (middle - 0.5 * chord) * ray;
    return true;
}

float clip_depth(vec3 hit) {
    vec4 clip = projection * vec4(hit, 1.0);
    return 0.5 * clip.z / clip.w + 0.5;
}
