function F = fimake5(varargin)
% FIMAKE5  The twelve inertial loads of NASA-CR-202063, eqs. 3-12: ndof x 12.
%   fi = FIMAKE5(idof_tab, nnode, phir, mass), the call of the report (4.1.3): idof_tab: ndof x 2, node and code 1 to 6,
%   else a generalized dof, where columns 7 to 12 are zero; nnode: the highest node number; phir: ndof x 6, rigid-body
%   modes x y z, rotations about x y z; mass: ndof x ndof. Per unit of ax ay az, alx aly alz, wx2 wy2 wz2, wxwy wxwz
%   wywz, about the point about which phir rotates.
%   F = FIMAKE5(M, dof_map, xyz) or (..., R): phir from the coordinates xyz (nodes x 3, nodes numbered from 1) about the
%   point R (default: the origin). `bough integrals --fi` calculates the same.
if nargin == 4 && isscalar(varargin{2})
  [dof_map, num_nodes, rigid, M] = varargin{:};
else
  [M, dof_map, xyz] = varargin{1:3};
  R = [0 0 0];
  if nargin > 3, R = varargin{4}; end
  num_nodes = size(xyz, 1);
  rigid = treeflx_rigid(dof_map, xyz, R);
end
P = full(M * rigid);
nodes = treeflx_split(dof_map, num_nodes, P);
F = zeros(size(dof_map, 1), 12);
F(:, 1:6) = -P;
pairs = [1 1; 2 2; 3 3; 1 2; 1 3; 2 3];
one = eye(3);
for i = 1:size(dof_map, 1)
  code = dof_map(i, 2);
  if code < 1 || code > 6, continue, end
  rows = 3 * (code > 3) + (1:3);
  axis_of = mod(code - 1, 3) + 1;
  for c = 1:6
    r = pairs(c, 1); s = pairs(c, 2);
    turned = cross(one(r, :), nodes(rows, 3 + s, dof_map(i, 1))');
    if r ~= s, turned = turned + cross(one(s, :), nodes(rows, 3 + r, dof_map(i, 1))'); end
    F(i, 6 + c) = -turned(axis_of);
  end
end
end
