#include "sim/scene/camera.hpp"

#include <algorithm>
#include <numbers>
#include <set>
#include <string>

#include "model/config.hpp"
#include "sim/scene/mesh.hpp"
#include "sim/scene/option_parts.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

constexpr OptionParts kCameraParts{
    "--camera", "write for example --camera 'eye=0,1,3;target=0,0,0;up=0,1,0;fov=45;near=.1;far=100'"};

[[noreturn]] void fail(const std::string& what, std::string_view mend) { kCameraParts.fail(what, mend); }

void read_part(CameraRequest& request, std::string_view key, std::string_view value) {
  if (key == "eye") {
    request.eye = kCameraParts.vector(key, value);
  } else if (key == "target") {
    request.target = kCameraParts.vector(key, value);
  } else if (key == "up") {
    request.up = kCameraParts.vector(key, value);
    if (length(*request.up) == 0) fail("up=0,0,0 has no direction", "write up=0,1,0");
  } else if (key == "fov") {
    request.fov = kCameraParts.positive(key, value);
    if (*request.fov >= 180) fail("fov=" + printable(value) + " is not below 180 degrees", "choose 20 to 120");
  } else if (key == "ortho") {
    request.ortho = kCameraParts.positive(key, value);
  } else if (key == "near") {
    request.near = kCameraParts.positive(key, value);
  } else if (key == "far") {
    request.far = kCameraParts.positive(key, value);
  } else if (key == "orbit") {
    request.orbit = kCameraParts.number(key, value);
  } else if (key == "name") {
    if (value.empty()) fail("name= without a name", "write name=NAME");
    request.name = std::string(value);
  } else {
    fail("unknown part " + in_quotes(key), "the parts are eye, target, up, fov, ortho, near, far, orbit and name");
  }
}

constexpr double kFrameMargin = 1.06;  // space around the mesh, as a factor of its size in the view

double half_fov(double degrees) { return degrees * std::numbers::pi / 360; }

struct Sphere {
  Vec3 center{};
  double radius = 0;
};

// The centre of the vertices' box and the distance of the farthest vertex from it.
Sphere bounding_sphere(const Mesh& mesh) {
  Vec3 low = mesh.vertices.front().position, high = low;
  for (const MeshVertex& vertex : mesh.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], vertex.position[i]);
      high[i] = std::max(high[i], vertex.position[i]);
    }
  }
  Sphere sphere{scaled(add(low, high), 0.5), 0};
  for (const MeshVertex& vertex : mesh.vertices) {
    sphere.radius = std::max(sphere.radius, length(subtract(vertex.position, sphere.center)));
  }
  // A mesh of one point still needs a size, large enough to be added to its position in binary64.
  sphere.radius = std::max({sphere.radius, 1e-9 * length(sphere.center), 1e-30});
  return sphere;
}

// An up vector not along the view: the given one if possible.
Vec3 usable_up(const Vec3& up, const Vec3& forward) {
  if (length(cross(forward, normalized(up))) >= 1e-9) return normalized(up);
  if (std::abs(forward[2]) < 0.7) return {0, 0, -1};  // looking straight down, as on a map
  return {0, 1, 0};
}

// Distance of the eye from the target along `back` for the view cone to contain every vertex.
double fitting_distance(const Camera& camera, const Mesh& mesh, const Vec3& back, double radius, double aspect) {
  const double half_height = std::tan(half_fov(camera.fov)), half_width = half_height * aspect;
  const Vec3 right = normalized(cross(camera.up, back)), up = cross(back, right);
  double distance = 1e-3 * radius;
  for (const MeshVertex& vertex : mesh.vertices) {
    const Vec3 offset = scaled(subtract(vertex.position, camera.target), kFrameMargin);
    const double across = std::max(std::abs(dot(offset, right)) / half_width, std::abs(dot(offset, up)) / half_height);
    distance = std::max(distance, dot(offset, back) + across);
  }
  return distance;
}

// The same for any direction: the sphere within the narrower of the view's two angles.
double fitting_distance(const Camera& camera, const Sphere& bounds, double aspect) {
  const double half_height = half_fov(camera.fov), half_width = std::atan(std::tan(half_height) * aspect);
  const double radius = bounds.radius + length(subtract(camera.target, bounds.center));
  return kFrameMargin * radius / std::sin(std::min(half_height, half_width));
}

// `v` rotated about a unit axis, counter-clockwise as seen from its tip (Rodrigues).
Vec3 turned_about(const Vec3& axis, double degrees, const Vec3& v) {
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  return add(add(scaled(v, c), scaled(cross(axis, v), s)), scaled(axis, dot(axis, v) * (1 - c)));
}

// near and far around the vertices' depths along the view, with some room.
void fit_planes(Camera& camera, const CameraRequest& request, const Mesh& mesh, const Vec3& forward, double radius) {
  if (request.near && request.far) {  // nothing to be computed
    camera.near = *request.near;
    camera.far = *request.far;
    return;
  }
  double front = dot(subtract(mesh.vertices.front().position, camera.eye), forward), back = front;
  for (const MeshVertex& vertex : mesh.vertices) {
    const double depth = dot(subtract(vertex.position, camera.eye), forward);
    front = std::min(front, depth);
    back = std::max(back, depth);
  }
  back += 0.05 * radius;
  camera.far = request.far.value_or(back > 0 ? back : 10 * radius);
  // Depth precision depends on near: it is kept away from the eye even if the eye is inside the mesh.
  front = std::max(front - 0.05 * radius, camera.far / 1000);
  camera.near = request.near.value_or(std::min(front, camera.far / 2));
  if (!request.far && camera.far <= camera.near) camera.far = 10 * camera.near;
}

}  // namespace

CameraRequest parse_camera(std::string_view text) {
  CameraRequest request;
  std::set<std::string, std::less<>> seen;
  while (!text.empty()) {
    const std::string_view part = OptionParts::cut(text, ';');
    if (part.empty()) continue;
    std::size_t equals = part.find('=');
    if (part == "orbit") equals = part.size();  // without a number: a full turn
    if (equals == std::string_view::npos) fail("no = in " + in_quotes(part), kCameraParts.example);
    const std::string_view key = OptionParts::trimmed(part.substr(0, equals));
    if (!seen.emplace(key).second) fail(in_quotes(key) + " is given twice", "leave one of them out");
    if (equals == part.size())
      request.orbit = 360;
    else
      read_part(request, key, OptionParts::trimmed(part.substr(equals + 1)));
  }
  if (request.fov && request.ortho) fail("fov and ortho together", "leave one of them out");
  return request;
}

CameraRequest merged(const CameraRequest& request, const CameraRequest& defaults) {
  CameraRequest result = request;
  if (!result.eye) result.eye = defaults.eye;
  if (!result.target) result.target = defaults.target;
  if (!result.up) result.up = defaults.up;
  if (!result.near) result.near = defaults.near;
  if (!result.far) result.far = defaults.far;
  if (!result.orbit) result.orbit = defaults.orbit;
  if (!request.ortho && !request.fov) {
    result.fov = defaults.fov;
    result.ortho = defaults.ortho;
  }
  if (result.ortho && result.far && std::isinf(*result.far)) result.far.reset();
  return result;
}

Camera frame(const CameraRequest& request, const Mesh& mesh, double aspect) {
  if (request.name) {
    fail("name=" + printable(*request.name) + ": this scene has no cameras of its own", kCameraParts.example);
  }
  const bool is_all_given = request.eye && request.target && request.near && request.far;
  const Sphere bounds = is_all_given ? Sphere{} : bounding_sphere(mesh);
  Camera camera;
  camera.target = request.target.value_or(bounds.center);
  camera.fov = request.fov.value_or(camera.fov);
  camera.ortho = request.ortho.value_or(0);
  const Vec3 up = request.up.value_or(camera.up), three_quarter = normalized({0.5, 0.45, 0.85});
  if (request.eye) {
    camera.eye = *request.eye;
  } else {
    camera.up = usable_up(up, scaled(three_quarter, -1));
    const double distance = camera.ortho > 0 ? 2 * bounds.radius + length(subtract(camera.target, bounds.center))
                            : request.orbit  ? fitting_distance(camera, bounds, aspect)
                                             : fitting_distance(camera, mesh, three_quarter, bounds.radius, aspect);
    camera.eye = add(camera.target, scaled(three_quarter, distance));
  }
  Vec3 view = subtract(camera.target, camera.eye);
  if (length(view) == 0) fail("eye and target are the same point", "move one of them");
  camera.up = usable_up(up, normalized(view));
  if (request.orbit) {
    const Vec3 axis = normalized(up);
    view = turned_about(axis, *request.orbit, view);
    camera.eye = subtract(camera.target, view);
    camera.up = turned_about(axis, *request.orbit, camera.up);
  }
  const Vec3 forward = normalized(view);
  fit_planes(camera, request, mesh, forward, bounds.radius);
  if (!(camera.near < camera.far)) {
    fail("near=" + std::to_string(camera.near) + " is not nearer than far=" + std::to_string(camera.far),
         "choose near < far");
  }
  return camera;
}

Mat4 view_matrix(const Camera& camera) {
  const Vec3 back = normalized(subtract(camera.eye, camera.target));
  const Vec3 right = normalized(cross(camera.up, back));
  const Vec3 up = cross(back, right);
  const auto row = [&camera](const Vec3& axis) { return Vec4{axis[0], axis[1], axis[2], -dot(axis, camera.eye)}; };
  return {row(right), row(up), row(back), Vec4{0, 0, 0, 1}};
}

Mat4 projection_matrix(const Camera& camera, double aspect) {
  const double n = camera.near, f = camera.far;
  if (camera.ortho > 0) {
    const double scale = 2 / camera.ortho;
    return {Vec4{scale / aspect, 0, 0, 0}, Vec4{0, scale, 0, 0}, Vec4{0, 0, -2 / (f - n), -(f + n) / (f - n)},
            Vec4{0, 0, 0, 1}};
  }
  const double scale = 1 / std::tan(half_fov(camera.fov));
  if (std::isinf(f)) {  // the limit of the matrix below
    return {Vec4{scale / aspect, 0, 0, 0}, Vec4{0, scale, 0, 0}, Vec4{0, 0, -1, -2 * n}, Vec4{0, 0, -1, 0}};
  }
  return {Vec4{scale / aspect, 0, 0, 0}, Vec4{0, scale, 0, 0}, Vec4{0, 0, -(f + n) / (f - n), -2 * f * n / (f - n)},
          Vec4{0, 0, -1, 0}};
}

Mat4 product(const Mat4& left, const Mat4& right) {
  Mat4 result{};
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      for (std::size_t i = 0; i < 4; ++i) result[row][column] += left[row][i] * right[i][column];
  return result;
}

Vec4 transform(const Mat4& matrix, const Vec4& point) {
  Vec4 result{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t i = 0; i < 4; ++i) result[row] += matrix[row][i] * point[i];
  }
  return result;
}

}  // namespace halfplane
