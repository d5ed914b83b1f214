# A comment behind the declaration of several members is about each of them: Doxygen would give it
# to the last alone.
:again
s#( [A-Za-z_0-9]+( = [^,;()<>/]*| = [A-Za-z_0-9:<>]*\(\)|\{[^,;()<>]*\})?), (([^()<>/]|\(\)|<[A-Za-z_0-9]*>)*; +///< )(.*)$#\1 /**< \5 */, \3\5#
t again
