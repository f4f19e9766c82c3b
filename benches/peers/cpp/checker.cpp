// The collision check for Python, by way of ctypes.
#include "scene.hpp"

#include <iostream>

extern "C" {
/// Null, and a message on stderr, if the file is no scene.
const Scene *scene_read(const char *file) {
    try {
        return new Scene(file);
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return nullptr;
    }
}

int scene_collides(const Scene *scene, double q1, double q2) { return scene->collides(q1, q2); }
}
