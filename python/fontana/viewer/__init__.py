"""The window of `fontana view`: a simulation that runs live, or a cache that is played.

What there is to see comes from a source (`live`, `player`); what the user wants is in the `model`; `panel`, `bars` and
`overlay` draw both with Dear ImGui; `hands` turns mouse and keys into calls of the model; `window` owns the OpenGL
context and the loop. Sources and model know no OpenGL and are tested without a window.
"""
