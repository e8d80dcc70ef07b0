function [s, notes] = bough_read(path)
% BOUGH_READ  Everything in a file of Bough: results, flexible body, modes, static solution, linear model, sweep, ...
%   s = BOUGH_READ('run.h5') is a struct with the names of the file: s.time, s.sensors.tip, s.bodies.boom.eta; s.format
%   says which kind it is. Arrays have the dimensions of the file in their order (phi(k, c, j): node, component, mode),
%   vectors are columns, texts are cells, a single text is char. Signs that MATLAB does not take in names become _, and
%   a name that begins with none of its letters, or is a word of its language, gets an x in front: s.subcases.x3.
%   [s, notes] = BOUGH_READ(...): notes('/sensors/tip') is a struct of that item's attributes (description, dims),
%   notes('/') of the file's.
%   Needs nothing else, in MATLAB and Octave alike: it reads the bytes of HDF5 files as Bough writes them (superblock and
%   object headers of results 2, of other files 0 and 1; no filters), after The HDF Group, "HDF5 File Format Specification
%   Version 3.0".
[file, why] = fopen(path, 'r');
if file < 0, error('bough_read: %s: %s', path, why); end
b = fread(file, Inf, '*uint8');
fclose(file);
if numel(b) < 96 || ~isequal(b(1:8)', uint8([137 72 68 70 13 10 26 10]))
  error('bough_read: %s is no HDF5 file', path);
end
% The version of the superblock says where the sizes of addresses and lengths are, and the address of the root group.
if b(9) == 0, sizes = b(14:15); root = 64; else, sizes = b(10:11); root = 36; end
if ~any(b(9) == [0 2]) || any(sizes ~= 8)
  error('bough_read: %s is an HDF5 file, but not as Bough writes them', path);
end
notes = containers.Map('KeyType', 'char', 'ValueType', 'any');
heaps = containers.Map('KeyType', 'double', 'ValueType', 'any');
s = read_object(b, number(b, root, 8), '/', notes, heaps);
root = notes('/');
if ~isfield(root, 'format') || ~strncmp(root.format, 'bough-', 6)
  error('bough_read: %s is no file of Bough: it has no attribute format', path);
end
s.format = root.format;
end

function value = number(b, at, size)
% Unsigned, little-endian, `size` bytes from byte `at` (from 0); all bits set is the address of nothing.
value = sum(double(b(at + 1:at + size))' .* 256 .^ (0:size - 1));
end

function yes = is_nowhere(address)
yes = address >= 2^63;
end

function name = valid(name)
name = regexprep(name, '[^A-Za-z0-9_]', '_');
if isempty(name) || ~isletter(name(1)) || iskeyword(name), name = ['x' name]; end
end

function value = read_object(b, at, path, notes, heaps)
% A group as a struct, or a dataset as an array.
messages = list_messages(b, at);
value = struct(); type = []; dims = []; layout = -1; attributes = struct();
for k = 1:numel(messages)
  m = messages(k);
  switch m.type
    case 1, dims = read_dims(b, m.at);
    case 3, type = read_type(b, m.at);
    case 6
      [name, target] = read_link(b, m.at);
      value = add_member(value, b, target, path, name, notes, heaps);
    case 8, layout = m.at;
    case 12
      [name, one] = read_attribute(b, m.at, heaps);
      attributes.(valid(name)) = one;
    case 17
      value = read_group(b, number(b, m.at, 8), number(b, m.at + 8, 8), path, notes, heaps);
  end
end
notes(path) = attributes;
if layout >= 0, value = convert(b, read_data(b, layout, type.size, dims), type, dims, heaps); end
end

function messages = list_messages(b, at)
% Types and places of what an object header holds, its continuations too.
messages = struct('type', {}, 'at', {});
is_second = isequal(char(b(at + 1:at + 4)'), 'OHDR');
if is_second
  flags = double(b(at + 6));
  width = 2 ^ mod(flags, 4);
  first = at + 6 + 16 * (bitand(flags, 32) > 0) + 4 * (bitand(flags, 16) > 0);
  blocks = [first + width, number(b, first, width)];
  prefix = 4 + 2 * (bitand(flags, 4) > 0);
elseif b(at + 1) == 1
  blocks = [at + 16, number(b, at + 8, 4)];
  prefix = 8;
else
  error('bough_read: an object header of version %d', b(at + 1));
end
while ~isempty(blocks)
  place = blocks(1, 1); last = place + blocks(1, 2);
  blocks(1, :) = [];
  while place + prefix <= last
    if is_second
      type = double(b(place + 1)); size = number(b, place + 1, 2);
    else
      type = number(b, place, 2); size = number(b, place + 2, 2);
    end
    body = place + prefix;
    if type == 16
      % A block of version 2 has a signature and a checksum around its messages.
      blocks(end + 1, :) = [number(b, body, 8) + 4 * is_second, number(b, body + 8, 8) - 8 * is_second];
    elseif type ~= 0
      messages(end + 1) = struct('type', type, 'at', body);
    end
    place = body + size;
  end
end
end

function [name, target] = read_link(b, at)
% A hard link: name and address of the object.
flags = double(b(at + 2));
place = at + 2 + (bitand(flags, 8) > 0) + 8 * (bitand(flags, 4) > 0) + (bitand(flags, 16) > 0);
width = 2 ^ mod(flags, 4);
size = number(b, place, width);
name = char(b(place + width + 1:place + width + size)');
target = number(b, place + width + size, 8);
end

function s = add_member(s, b, at, path, name, notes, heaps)
field = valid(name);
while isfield(s, field), field = [field '_']; end
s.(field) = read_object(b, at, [regexprep(path, '/$', '') '/' name], notes, heaps);
end

function s = read_group(b, tree, heap, path, notes, heaps)
s = struct();
names = number(b, heap + 24, 8);
tables = list_leaves(b, tree, 8);
for k = 1:numel(tables)
  table = tables(k);
  for i = 0:number(b, table + 6, 2) - 1
    entry = table + 8 + 40 * i;
    first = names + number(b, entry, 8);
    last = first + find(b(first + 1:end) == 0, 1) - 1;
    name = char(b(first + 1:last)');
    s = add_member(s, b, number(b, entry + 8, 8), path, name, notes, heaps);
  end
end
end

function [leaves, keys] = list_leaves(b, at, key_size)
% Children of the lowest nodes of a B-tree of version 1, and where the keys before them stand.
leaves = []; keys = [];
if is_nowhere(at), return, end
count = number(b, at + 6, 2);
places = at + 24 + (0:count - 1) * (key_size + 8);
for place = places
  child = number(b, place + key_size, 8);
  if b(at + 6) == 0
    leaves(end + 1) = child; keys(end + 1) = place;
  else
    [more, their] = list_leaves(b, child, key_size);
    leaves = [leaves more]; keys = [keys their];
  end
end
end

function dims = read_dims(b, at)
% Empty for a scalar.
rank = double(b(at + 2));
first = at + 8 - 4 * (b(at + 1) == 2);
dims = zeros(1, rank);
for k = 1:rank, dims(k) = number(b, first + 8 * (k - 1), 8); end
end

function type = read_type(b, at)
type.size = number(b, at + 4, 4);
class = mod(double(b(at + 1)), 16); bits = double(b(at + 2));
switch class
  case 0
    names = {'uint8', 'uint16', '', 'uint32', '', '', '', 'uint64'};
    type.kind = names{type.size};
    if bitand(bits, 8), type.kind = type.kind(2:end); end
  case 1
    names = {'', '', '', 'single', '', '', '', 'double'};
    type.kind = names{type.size};
  case 3, type.kind = 'fixed text';
  case 9
    type.kind = 'text';
    if mod(bits, 16) ~= 1, type.kind = 'list'; end
  otherwise, type.kind = 'other';
end
end

function [name, value] = read_attribute(b, at, heaps)
version = b(at + 1);
sizes = [number(b, at + 2, 2), number(b, at + 4, 2), number(b, at + 6, 2)];
place = at + 8 + (version == 3);
name = char(b(place + 1:place + sizes(1) - 1)');
name(name == 0) = [];
if version == 1, sizes = 8 * ceil(sizes / 8); end
type = read_type(b, place + sizes(1));
dims = read_dims(b, place + sizes(1) + sizes(2));
first = place + sum(sizes);
value = convert(b, b(first + 1:first + type.size * prod(dims)), type, dims, heaps);
end

function bytes = read_data(b, at, size, dims)
% The bytes of a dataset in its order; what was never written is zero.
count = prod(dims);
bytes = zeros(size * count, 1, 'uint8');
switch b(at + 2)
  case 0
    bytes = b(at + 5:at + 4 + number(b, at + 2, 2));
  case 1
    first = number(b, at + 2, 8);
    if ~is_nowhere(first), bytes = b(first + 1:first + size * count); end
  case 2
    rank = double(b(at + 3)) - 1;
    chunk = zeros(1, rank);
    for k = 1:rank, chunk(k) = number(b, at + 11 + 4 * (k - 1), 4); end
    [chunks, keys] = list_leaves(b, number(b, at + 3, 8), 8 + 8 * (rank + 1));
    % Last dimension first, as MATLAB counts; a byte of an item is one more before it.
    whole = zeros([size, fliplr(dims), 1], 'uint8');
    for k = 1:numel(chunks)
      first = zeros(1, rank);
      for i = 1:rank, first(i) = number(b, keys(k) + 8 + 8 * (i - 1), 8); end
      room = min(chunk, dims - first);
      part = reshape(b(chunks(k) + 1:chunks(k) + size * prod(chunk)), [size, fliplr(chunk), 1]);
      from = {':'}; to = {':'};
      for i = rank:-1:1
        from{end + 1} = 1:room(i);
        to{end + 1} = first(i) + (1:room(i));
      end
      whole(to{:}) = part(from{:});
    end
    bytes = whole(:);
end
end

function value = convert(b, bytes, type, dims, heaps)
switch type.kind
  case {'text', 'fixed text'}
    count = prod(dims);
    value = cell(count, 1);
    for k = 1:count
      one = bytes((k - 1) * type.size + 1:k * type.size);
      if strcmp(type.kind, 'text'), one = take_text(b, one, heaps); end
      one(cumsum(one == 0) > 0) = [];
      value{k} = to_char(one);
    end
    if isempty(dims), value = value{1}; return, end
  case {'list', 'other'}
    value = []; return
  otherwise
    value = typecast(bytes(:), type.kind);
    if isempty(dims), return, end
end
rank = numel(dims);
if rank > 1, value = permute(reshape(value, fliplr(dims)), rank:-1:1); end
end

function text = to_char(bytes)
% UTF-8 as Octave keeps it; MATLAB decodes.
if exist('OCTAVE_VERSION', 'builtin'), text = char(bytes(:)'); else, text = native2unicode(bytes(:)', 'UTF-8'); end
end

function bytes = take_text(b, reference, heaps)
% Of a global heap: length, address of the heap, number of the object in it.
size = number(reference, 0, 4); heap = number(reference, 4, 8); index = number(reference, 12, 4);
bytes = zeros(0, 1, 'uint8');
if size == 0 || heap == 0 || is_nowhere(heap), return, end
if ~isKey(heaps, heap)
  places = containers.Map('KeyType', 'double', 'ValueType', 'double');
  at = heap + 16; last = heap + number(b, heap + 8, 8);
  while at + 16 <= last
    object = number(b, at, 2);
    if object == 0, break, end
    places(object) = at + 16;
    at = at + 16 + 8 * ceil(number(b, at + 8, 8) / 8);
  end
  heaps(heap) = places;
end
places = heaps(heap);
first = places(index);
bytes = b(first + 1:first + size);
end
