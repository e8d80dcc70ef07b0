function out = modall(varargin)
% MODALL  Generalized matrices and the five mass integrals by the nodal formulas of NASA-CR-202063, 4.2.2.
%   out = MODALL(idof_tab, nnode, phir, mass, stiff, phi, body_mass), the arguments of FIMAKE5 and what a .FLX needs
%   besides: idof_tab: ndof x 2, node (numbers may have gaps) and code; nnode: the highest node number; phir: ndof x 6,
%   rigid-body modes, which give the places of the nodes (a node with one translation is an error); mass, stiff: ndof x
%   ndof; phi: ndof x n.
%   out = MODALL(M, K, Phi, dof_map, xyz, body_mass) or (..., R): places by coordinates, about the point R.
%   A struct with mass, stiffness (n x n), gamma0, gamma1, alpha = gamma0 / body_mass (n x 3), gamma2 (n x n x 3),
%   gamma3 (n x 3 x 3), gamma4 (n x n x 3 x 3); special (6 x n x n+1): gains of the special nodes, none of the first, a
%   unit x translation in mode j of node j + 1. `bough integrals` calculates the same.
if nargin == 7 && isscalar(varargin{2})
  [dof_map, num_nodes, rigid, M, K, Phi, mass] = varargin{:};
  xyz = find_places(dof_map, num_nodes, rigid);
else
  [M, K, Phi, dof_map, xyz, mass] = varargin{1:6};
  R = [0 0 0];
  if nargin > 6, R = varargin{7}; end
  xyz = xyz - repmat(R(:)', size(xyz, 1), 1);
end
n = size(Phi, 2);
M_Phi = full(M * Phi);
A = treeflx_split(dof_map, size(xyz, 1), M_Phi);
phi = treeflx_split(dof_map, size(xyz, 1), full(Phi));
out.mass = Phi' * M_Phi;
out.stiffness = full(Phi' * (K * Phi));
out.gamma0 = zeros(n, 3); out.gamma1 = zeros(n, 3); out.gamma2 = zeros(n, n, 3);
out.gamma3 = zeros(n, 3, 3); out.gamma4 = zeros(n, n, 3, 3);
for k = 1:size(xyz, 1)
  p = xyz(k, :);
  for j = 1:n
    a = A(1:3, j, k)';
    out.gamma0(j, :) = out.gamma0(j, :) + a;
    out.gamma1(j, :) = out.gamma1(j, :) + A(4:6, j, k)' + cross(p, a);
    out.gamma3(j, :, :) = squeeze(out.gamma3(j, :, :)) + (p * a') * eye(3) - a' * p;
    for l = 1:n
      f = phi(1:3, l, k)';
      out.gamma2(j, l, :) = squeeze(out.gamma2(j, l, :))' + cross(a, f);
      out.gamma4(j, l, :, :) = squeeze(out.gamma4(j, l, :, :)) + (a * f') * eye(3) - a' * f;
    end
  end
end
out.alpha = out.gamma0 / mass;
out.special = zeros(6, n, n + 1);
for j = 1:n, out.special(1, j, j + 1) = 1; end
end

function xyz = find_places(dof_map, num_nodes, rigid)
% Places of the nodes from rotations of the rigid-body modes: row c of a node has (e_s x p)_c in column 3 + s.
xyz = zeros(num_nodes, 3);
count = zeros(num_nodes, 1);
for i = 1:size(dof_map, 1)
  c = dof_map(i, 2);
  if c < 1 || c > 3, continue, end
  next = mod(c, 3) + 1;
  last = mod(c + 1, 3) + 1;
  xyz(dof_map(i, 1), last) = rigid(i, 3 + next);
  xyz(dof_map(i, 1), next) = -rigid(i, 3 + last);
  count(dof_map(i, 1)) = count(dof_map(i, 1)) + 1;
end
if any(count == 1)
  error('modall: node %d has one translation, which leaves its place open; give coordinates xyz', find(count == 1, 1));
end
end
