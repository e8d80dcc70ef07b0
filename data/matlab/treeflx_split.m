function blocks = treeflx_split(dof_map, num_nodes, X)
% TREEFLX_SPLIT  6 x columns of X x nodes, zero where the map has no such dof.
blocks = zeros(6, size(X, 2), num_nodes);
for i = 1:size(dof_map, 1)
  code = dof_map(i, 2);
  if code >= 1 && code <= 6, blocks(code, :, dof_map(i, 1)) = X(i, :); end
end
end
