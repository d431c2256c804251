#include "services/ros2/definitions.h"

#include <algorithm>
#include <array>
#include <vector>

#include "services/types/check.h"

namespace giveway::ros2 {
namespace {

struct Known {
  std::string_view type;
  std::string_view fields;
  std::array<std::string_view, 9> of{};  // types of its fields, in order
};

// The public definitions of ROS 2 Jazzy. In Humble Range has no `variance`, and Marker no
// ARROW_STRIP.
constexpr Known kKnown[] = {
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Pose",
     "Point position\nQuaternion orientation\n",
     {"geometry_msgs/Point", "geometry_msgs/Quaternion"}},
    {"geometry_msgs/PoseWithCovariance",
     "Pose pose\nfloat64[36] covariance\n",
     {"geometry_msgs/Pose"}},
    {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    {"geometry_msgs/Transform",
     "Vector3 translation\nQuaternion rotation\n",
     {"geometry_msgs/Vector3", "geometry_msgs/Quaternion"}},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\nTransform transform\n",
     {"std_msgs/Header", "geometry_msgs/Transform"}},
    {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n", {"geometry_msgs/Vector3"}},
    {"geometry_msgs/TwistWithCovariance",
     "Twist twist\nfloat64[36] covariance\n",
     {"geometry_msgs/Twist"}},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\n"
     "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n",
     {"std_msgs/Header", "geometry_msgs/PoseWithCovariance", "geometry_msgs/TwistWithCovariance"}},
    {"sensor_msgs/CompressedImage",
     "std_msgs/Header header\nstring format\nuint8[] data\n",
     {"std_msgs/Header"}},
    {"sensor_msgs/Range",
     "std_msgs/Header header\nuint8 ULTRASOUND=0\nuint8 INFRARED=1\nuint8 radiation_type\n"
     "float32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\n"
     "float32 variance\n",
     {"std_msgs/Header"}},
    {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
    {"std_msgs/Header",
     "builtin_interfaces/Time stamp\nstring frame_id\n",
     {"builtin_interfaces/Time"}},
    {"tf2_msgs/TFMessage",
     "geometry_msgs/TransformStamped[] transforms\n",
     {"geometry_msgs/TransformStamped"}},
    {"visualization_msgs/Marker",
     "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\n"
     "int32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\n"
     "int32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\n"
     "int32 ARROW_STRIP=12\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n"
     "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
     "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
     "builtin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\n"
     "std_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\n"
     "UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\nMeshFile mesh_file\n"
     "bool mesh_use_embedded_materials\n",
     {"std_msgs/Header", "geometry_msgs/Pose", "geometry_msgs/Vector3", "std_msgs/ColorRGBA",
      "builtin_interfaces/Duration", "geometry_msgs/Point", "sensor_msgs/CompressedImage",
      "visualization_msgs/UVCoordinate", "visualization_msgs/MeshFile"}},
    {"visualization_msgs/MarkerArray", "Marker[] markers\n", {"visualization_msgs/Marker"}},
    {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
};

// As the alternatives of Body.
constexpr std::array<std::string_view, std::variant_size_v<Body>> kTypes{
    "nav_msgs/msg/Odometry", "sensor_msgs/msg/Range", "tf2_msgs/msg/TFMessage",
    "visualization_msgs/msg/MarkerArray", "geometry_msgs/msg/Twist"};

const Known& Find(std::string_view type) {
  const auto found = std::ranges::find(kKnown, type, &Known::type);
  GIVEWAY_CHECK(found != std::end(kKnown));
  return *found;
}

// The type, then those of its fields that are not in the list yet, each with its own.
void Collect(std::string_view type, std::vector<std::string_view>* list) {
  if (std::ranges::find(*list, type) != list->end()) return;
  list->push_back(type);
  for (const std::string_view field : Find(type).of) {
    if (!field.empty()) Collect(field, list);
  }
}

}  // namespace

std::string_view TypeOf(const Body& body) { return kTypes[body.index()]; }

std::string DefinitionOf(std::string_view type) {
  constexpr std::string_view kMsg = "msg/";
  std::string name(type);
  name.erase(name.find(kMsg), kMsg.size());
  std::vector<std::string_view> list;
  Collect(name, &list);
  std::string text(Find(name).fields);
  for (std::size_t i = 1; i < list.size(); ++i) {
    constexpr std::size_t kLine = 80;
    text += std::string(kLine, '=') + "\nMSG: " + std::string(list[i]) + "\n";
    text += Find(list[i]).fields;
  }
  return text;
}

Offer OfferOf(std::string_view topic) {
  constexpr int kUsualDepth = 10;
  constexpr int kRingDepth = 32;  // two of each ultrasonic: all of a ring come at once
  if (topic == "/tf_static") return {.transient_local = true, .depth = 1};
  if (topic == "/tf") return {.transient_local = false, .depth = 100};  // as tf2's broadcaster
  return {.transient_local = false,
          .depth = topic.ends_with("/ultrasonics") ? kRingDepth : kUsualDepth};
}

std::string QosProfileOf(std::string_view topic) {
  const Offer offer = OfferOf(topic);
  // The numbers of rmw/types.h: keep last 1, reliable 1, transient local 1, volatile 2, automatic
  // 1; a duration of 0 is none.
  const auto none = [](const std::string& name) {
    return "  " + name + ":\n    sec: 0\n    nsec: 0\n";
  };
  return "- history: 1\n  depth: " + std::to_string(offer.depth) +
         "\n  reliability: 1\n  durability: " + (offer.transient_local ? "1" : "2") + "\n" +
         none("deadline") + none("lifespan") + "  liveliness: 1\n" +
         none("liveliness_lease_duration") + "  avoid_ros_namespace_conventions: false\n";
}

}  // namespace giveway::ros2
